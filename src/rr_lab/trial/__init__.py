"""The blind trial: sealed cases of the laboratory, diagnosed by a program of its own, scored."""
