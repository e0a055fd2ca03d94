"""From the equation of motion to motion: integrators, rollouts and the steady cycle."""
