"""Figures of a diagnosis: evidence, paths, what the simulation leaves, before and after."""
