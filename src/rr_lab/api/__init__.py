"""What the laboratory offers: recordings of a virtual robot, and the blind trial."""
