"""System identification of a machine that is known by its protocol alone."""
