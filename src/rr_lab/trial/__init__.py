"""The blind trial: sealed cases of the laboratory, diagnosed by a separate program, and scored."""
