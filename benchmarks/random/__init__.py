"""Problems and turns drawn at random, against a brute force that shares no code with the package."""
