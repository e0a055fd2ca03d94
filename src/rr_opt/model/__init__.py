"""What is asked, as plain frozen data: the robot, its gait, limits, a problem, an experiment."""
