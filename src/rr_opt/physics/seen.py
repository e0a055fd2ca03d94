"""What a capture system sees of the robot."""

from __future__ import annotations

from dataclasses import dataclass

import casadi as ca


@dataclass(frozen=True)
class Seen:
    """The tracked point x, y (m), the heading psi and the angle phi (rad), as expressions."""

    x: ca.SX
    y: ca.SX
    psi: ca.SX
    phi: ca.SX
