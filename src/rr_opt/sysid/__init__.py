"""System identification of any machine that implements the protocol."""
