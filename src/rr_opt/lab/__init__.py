"""A laboratory in another physics engine: recordings with known or sealed physics in them."""
