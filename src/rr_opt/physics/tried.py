"""What is found out about a derived equation of motion by trying it in numbers."""

from __future__ import annotations

import casadi as ca
import numpy as np


def affine(vdot: ca.Function) -> bool:
    """Whether vdot (v, phi, dphi, ddphi, p) is affine in v.

    Terms in v^2 cancel between the bodies, but only once sines and cosines are multiplied out,
    which CasADi does not do; so the second difference in v is looked at in numbers.
    """
    p = np.linspace(0.5, 1.5, vdot.numel_in(4))
    for phi, dphi, ddphi in ((0.3, 1.0, -2.0), (-1.1, 0.7, 3.0), (0.8, -2.0, 0.5)):
        low, middle, high = (float(vdot(v, phi, dphi, ddphi, p)) for v in (-1.0, 0.0, 1.0))
        if abs(low - 2 * middle + high) > 1e-9 * (abs(low) + abs(middle) + abs(high)):
            return False
    return True


def mirrored(motion: ca.Function) -> bool:
    """Whether `Dynamics.motion` gives the mirrored state the mirrored rates."""
    p = np.linspace(0.5, 1.5, motion.numel_in(4))
    for v, phi, dphi, ddphi in ((0.7, 0.3, 1.0, -2.0), (-1.0, -0.9, 0.7, 3.0)):
        here, there = (
            np.array([float(out) for out in motion(v, sign * phi, sign * dphi, sign * ddphi, p)])
            for sign in (1, -1)
        )
        if not np.allclose(there, here * [1, -1, -1, -1], rtol=1e-9, atol=1e-9):
            return False
    return True
