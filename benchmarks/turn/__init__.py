"""The fastest turns, against a search that shares no code with the package."""
