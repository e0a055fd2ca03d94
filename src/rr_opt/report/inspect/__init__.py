"""A recording inspected: the page, the record for scripts and the text for a terminal."""
