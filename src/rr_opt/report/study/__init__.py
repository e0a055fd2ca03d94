"""What a study tells."""
