"""Figures of a recording: the path, its channels, its command, its noise."""
