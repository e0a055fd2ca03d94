"""What a diagnosis said of a pendulum, as a figure."""
