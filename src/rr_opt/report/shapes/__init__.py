"""What a comparison of shapes tells."""
