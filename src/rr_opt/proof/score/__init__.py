"""What a diagnosis said, held against what was hidden: pure functions of the two."""
