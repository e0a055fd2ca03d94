"""Turns by the sweep's model."""
