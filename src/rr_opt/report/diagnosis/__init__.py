"""The report of a diagnosis: page, record, corrected robot, and text for a terminal."""
