"""A laboratory in two other physics engines: recordings with known or sealed physics in them.

The blind trial of the diagnosis is in `trial`.
"""
