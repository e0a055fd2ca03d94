"""The equations of motion as each tool's user would type them in: the paper's closed form.

The signs are the corrected ones of docs/model.md. `sin` and `cos` are the tool's own. No line of
`rr_opt` is used, so that a fit by any other tool is a second way to the same answer.
"""

from __future__ import annotations

from typing import Any

PARAMETERS = ("kappa1", "kappa2", "I1", "I2", "a1", "a2")
"""What is fitted: the wheels' friction (N m s), the inertias (kg m2), the centres of mass (m)."""

M1, M2, C1, C2, B1, B2, H = 0.469, 0.25, 0.236, 0.0941, 0.05, 0.05, 0.02
"""What is known of the robot: masses, axles to the joint, half tracks, wheel radius; SI."""


def rates(state: Any, drive: Any, p: Any, sin: Any, cos: Any) -> list[Any]:
    """d/dt of x, y, psi, v. drive: phi, dphi, ddphi; p: as PARAMETERS."""
    _, _, psi, v = state
    phi, dphi, ddphi = drive
    kappa1, kappa2, I1, I2, a1, a2 = p
    k1, k2 = kappa1 / H**2, kappa2 / H**2
    M = M1 + M2
    delta = C1 * a2 * M2 + C2 * a1 * M1
    epsilon = M1 * a1 + C1 * M2
    J1 = I1 + I2 + M1 * a1**2 + M2 * (a2**2 + C1**2 - C2**2)
    J2 = I2 - M2 * (C2**2 - a2**2)
    s, c = sin(phi), cos(phi)
    S1, S2 = C1 * c + C2, C1 + C2 * c
    Dn = J1 * s**2 + M * S1**2
    A = -dphi * s * (J1 * S2 + delta * S1) / (S1 * Dn)
    C = 2 * ((B1**2 * k1 + B2**2 * k2) * s**2 + k1 * S1**2 + k2 * S2**2) / Dn
    first = -ddphi * s * (J1 * C2 - J2 * S1) / Dn
    arms = C1 * delta * c - epsilon * C2 * S1
    second = -(dphi**2) * (J1 * C1 * C2 * s**2 - S1 * arms) / (S1 * Dn)
    loss = C1 * k2 * (B2**2 - C2**2) * c - C2 * (B1**2 * k1 + C1**2 * k2)
    D = 2 * dphi * s * loss / Dn
    w = -(v * s + C2 * dphi) / S1
    along, across = cos(psi), sin(psi)
    return [
        v * along + C1 * w * across,
        v * across - C1 * w * along,
        w,
        (A - C) * v + first + second + D,
    ]
