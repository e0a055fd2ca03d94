"""Markers on two rigid platforms: which is which, and the motion they show."""
