"""A gait as set points."""
