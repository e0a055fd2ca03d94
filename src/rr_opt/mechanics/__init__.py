"""Bodies, kinematics, Kane's equations, the servo's drive, integrators, compiled code."""
