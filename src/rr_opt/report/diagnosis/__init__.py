"""A diagnosis told: the page, the record for scripts, the corrected robot, the terminal's text."""
