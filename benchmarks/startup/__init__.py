"""How soon `rr-opt` answers, against what Python and its libraries take to load at all."""
