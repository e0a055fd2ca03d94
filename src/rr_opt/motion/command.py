"""The commanded angle for CasADi: an expression in time, and the numbers of each smooth piece.

Where phi is smooth a gait is one piece without end. Where its acceleration jumps it is cut at the
jumps, as no method of high order may step across one. The pieces of a gait differ in their numbers
alone, so that they share an expression, and gaits of one form share what is compiled from it.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import casadi as ca
import numpy as np

from rr_opt.array import Array
from rr_opt.model.gait import FourierGait, FreeGait, Gait, SineGait


@dataclass(frozen=True)
class Form:
    """How phi is written on a piece: as so many harmonics, or, where there are none, as a parabola.

    The numbers are period, offset, sines, cosines with t = 0 where the gait begins, or phi, its
    rate and its acceleration at t = 0, where the piece begins.
    """

    harmonics: int = 0

    @property
    def size(self) -> int:
        """How many numbers."""
        return 2 + 2 * self.harmonics if self.harmonics else 3

    def command(self, t: ca.SX, numbers: ca.SX) -> tuple[ca.SX, ca.SX, ca.SX]:
        """phi (rad), dphi/dt (rad/s) and d2phi/dt2 (rad/s2) at t (s)."""
        if not self.harmonics:
            angle, rate, acceleration = ca.vertsplit(numbers)
            return angle + t * (rate + t * acceleration / 2), rate + t * acceleration, acceleration
        period, offset, *sizes = ca.vertsplit(numbers)
        phi, dphi, ddphi = offset, ca.SX(0), ca.SX(0)
        for n in range(1, self.harmonics + 1):
            omega = 2 * math.pi * n / period
            sine, cosine = sizes[n - 1], sizes[self.harmonics + n - 1]
            s, c = ca.sin(omega * t), ca.cos(omega * t)
            phi += sine * s + cosine * c
            dphi += omega * (sine * c - cosine * s)
            ddphi -= omega**2 * (sine * s + cosine * c)
        return phi, dphi, ddphi


def form_of(gait: Gait) -> Form:
    """The form in which a gait is written."""
    if isinstance(gait, FourierGait):
        return Form(gait.harmonics)
    return Form(0 if isinstance(gait, FreeGait) else 1)


def numbers_of(gait: Gait) -> Array:
    """The numbers of each piece, (form.size, gait.pieces)."""
    match gait:
        case SineGait():
            return np.array([[gait.period], [gait.offset], [gait.amplitude], [0.0]])
        case FourierGait():
            return np.array([gait.period, gait.offset, *gait.sines, *gait.cosines])[:, None]
        case FreeGait():
            angles, rates = gait.nodes
            return np.array([angles[:-1], rates[:-1], gait.accelerations])
        case _:
            raise TypeError(f"no expression is known for a gait of shape {gait.shape!r}")
