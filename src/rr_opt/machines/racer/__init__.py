"""The Roller Racer."""
