"""Recordings in: from the file of a capture system to a clean, synchronised recording."""
