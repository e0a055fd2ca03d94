"""Random problems and turns, against a brute force that shares no code with the package."""
