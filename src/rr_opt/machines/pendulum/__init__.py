"""A pendulum driven by a torque."""
