"""Input files: YAML with units, checked whole before anything runs, to frozen data."""
