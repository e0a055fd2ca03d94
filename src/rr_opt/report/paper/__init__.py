"""What the reproduction of the paper tells."""
