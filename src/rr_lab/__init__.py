"""A laboratory with two other physics engines: recordings with known or sealed physics.

The blind trial of the diagnosis is in `trial`.
"""
