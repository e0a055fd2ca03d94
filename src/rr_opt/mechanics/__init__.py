"""What a robot is made of: bodies, kinematics, Kane's equations, its drive; compiled code."""
