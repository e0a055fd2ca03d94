"""Why the robot does not do what the simulation says: where, what, how much, how sure."""
