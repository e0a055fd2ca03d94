"""The robot's equation of motion in closed form, for whatever has sin, cos, tanh and sqrt.

Written by hand and apart from the package. Forces of friction act at the wheels, which roll at
u1 -+ b1 w and u2 -+ b2 (w + q); what they do to v follows from how their speeds change with v.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

SMOOTH_DRY, SMOOTH_DRAG = 0.002, 1e-4
"""Speeds, m/s, below which dry friction and drag are smooth."""


def rates(
    sin: Callable,
    cos: Callable,
    tanh: Callable,
    sqrt: Callable,
    friction: str,
    wrap: Callable = lambda function: function,
) -> Callable:
    """(v, phi, q, r, p) -> vdot, w, side: q = dphi, r = ddphi, p 15 numbers or arrays as
    `Work.parameters` orders them; w is the yaw rate, P moves at (v, side).

    wrap: around the function that the result calls, for compilers that want it
    """
    viscous, dry = friction == "viscous", friction == "coulomb"

    @wrap
    def force(u: Any, k: Any, dry_force: Any, drag: Any) -> Any:
        if viscous:
            return k * u
        if dry:
            return k * u + dry_force * tanh(u / SMOOTH_DRY)
        return k * u + drag * u * sqrt(u * u + SMOOTH_DRAG * SMOOTH_DRAG)

    def motion(v: Any, phi: Any, q: Any, r: Any, p: Any) -> Any:
        m1, J1, ma1, c1, b1, k1 = p[0], p[1], p[2], p[3], p[4], p[5]
        m2, J2, ma2, c2, b2, k2 = p[6], p[7], p[8], p[9], p[10], p[11]
        s, c = sin(phi), cos(phi)
        S1, S2 = c1 * c + c2, c1 + c2 * c
        i, ss, qs = 1 / S1, s * s, q * s
        j = J1 + J2 + m2 * (c1 * c1 - c2 * c2)
        g = 1 / ((m1 + m2) * S1 * S1 + j * ss)
        inertia = (
            qs * (j * i * S2 + (ma1 * c2 + ma2 * c1)) * v
            + r * s * (J1 * c2 - J2 * c1 * c + m2 * c1 * c2 * S2)
            + q * q * (c1 * c2 * (j * ss * i + m2 * S1) + ma1 * c2 * c2 - ma2 * c1 * c1 * c)
        )
        w = -i * (s * v + c2 * q)
        u2, turn2 = i * (S2 * v + c1 * c2 * s * q), b2 * (w + q)
        left1, right1 = force(v - b1 * w, k1, p[12], p[14]), force(v + b1 * w, k1, p[12], p[14])
        left2, right2 = force(u2 - turn2, k2, p[13], p[14]), force(u2 + turn2, k2, p[13], p[14])
        # dw/dv = -i s, du2/dv = i S2
        resisted = left1 + right1 + (left1 - right1) * b1 * i * s
        resisted = resisted + (left2 + right2) * i * S2 + (left2 - right2) * b2 * i * s
        return -g * (inertia + S1 * S1 * resisted), w, -c1 * w

    return motion
