"""Studies: one problem with many values of its keys."""
