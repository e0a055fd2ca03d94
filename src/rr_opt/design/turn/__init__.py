"""Turns: gaits that go round a circle that is asked for."""
