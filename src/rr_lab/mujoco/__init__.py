"""The first engine: a three-dimensional robot in MuJoCo."""
