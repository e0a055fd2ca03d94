"""An instant of a step: what is guessed of its end, and what acts by the guess.

A step ends where its forces say, and they depend on where it ends. So its end is guessed, forces
are written as straight lines through the guess, and the end that these give is the next guess.
"""

from __future__ import annotations

from dataclasses import dataclass

import casadi as ca

from rr_opt.lab.planar.layout import Layout


@dataclass(frozen=True)
class Moment:
    """The end of a step as it is guessed.

    layout   with its coordinates q; w (n), their guessed rates; spins (4), rad/s, and turns (4),
             rad, of the wheels
    ahead    s, by which a change of w changes q
    asked    rad, the angle that the motor is to make; rate, rad/s, its own
    t        s since the robot was let go; free, 1 from then on and 0 before
    """

    layout: Layout
    w: ca.SX
    spins: ca.SX
    turns: ca.SX
    ahead: float
    asked: ca.SX
    rate: ca.SX
    t: ca.SX
    free: ca.SX

    def way(self, length: ca.SX) -> ca.SX:
        """How each coordinate lengthens a length or an angle (1, n)."""
        return ca.jacobian(length, self.layout.q)


@dataclass(frozen=True)
class Pull:
    """A force, or a torque, along a way (1, n): it is push - hold * (its speed at the step's end).

    hold is never negative: it is what keeps the step from running away.
    """

    way: ca.SX
    hold: ca.SX | float
    push: ca.SX | float


def spring(
    moment: Moment,
    length: ca.SX,
    stiffness: ca.SX | float,
    damping: ca.SX | float,
    rest: ca.SX | float = 0.0,
) -> Pull:
    """What a spring with a damper pulls; length and rest in m or rad. Exact where the length is
    straight in the coordinates."""
    way = moment.way(length)
    before = length - moment.ahead * (way @ moment.w)
    return Pull(way, damping + stiffness * moment.ahead, -stiffness * (before - rest))
