"""Gravity."""

G = 9.80665
"""Standard acceleration of free fall, m/s2 (3rd General Conference on Weights and Measures)."""
