"""What the robot is and what it is told to do: plain numbers in SI units."""
