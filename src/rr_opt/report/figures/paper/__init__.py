"""Figures beside the paper's."""
