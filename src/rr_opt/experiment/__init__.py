"""What was done with a robot and what was seen of it, as frozen data."""
