"""Results of `rr-opt calibrate`: the record, the tables, the words and the page."""
