"""What the reproduction and the calibration tell."""
