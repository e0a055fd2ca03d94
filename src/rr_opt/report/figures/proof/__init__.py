"""Figures of the blind trial."""
