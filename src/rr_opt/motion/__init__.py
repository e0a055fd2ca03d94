"""Equations of motion with any effects, integrators, rollouts and the steady cycle."""
