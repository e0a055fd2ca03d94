"""Figures of `rr-opt calibrate`."""
