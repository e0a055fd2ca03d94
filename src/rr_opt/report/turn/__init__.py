"""What turns, circles and the chart of them tell."""
