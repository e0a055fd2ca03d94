"""Ten routes on three robots, against gaits glued by hand and a coarse brute force."""
