"""The controller of a route in Python, as a reference for the C code that is shipped: an observer,
a regulator, and the choice of the period that comes next, as `rr_opt.routing.feedback` has it."""

import math
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from rr_opt.array import Array
from rr_opt.model.command import blended
from rr_opt.routing.feedback import (
    LONGEST,
    LOOKS,
    MARGIN,
    PERIOD,
    SLIPPERY,
    WAYS_BACK,
    Feedback,
    apart,
    moved,
)


@dataclass
class Follower:
    """A drive in progress with its controller: `first` and then, at the end of every period, `next`
    give the segment (A0, o0, omega0, A1, o1, omega1, theta0, D) for the joint to follow.

    period  the current one, from 0;  z  the estimate at its start
    """

    control: Feedback
    period: int = 0
    made: int = 0
    z: Array = field(default_factory=lambda: np.zeros(8))
    u: Array = field(default_factory=lambda: np.zeros(2))

    def first(self) -> Array:
        """The first segment."""
        return self._segment()

    def next(self, pose: Array) -> Array | None:
        """The segment after a pose x (m), y (m), psi (rad) observed `delay` before the end of the
        current one; None at the end of the drive."""
        c, k, z, u = self.control, self.period, self.z, self.u
        surprise = apart(pose, c.seen[k]) - c.H[k] @ _with_product(z) - c.G[k] @ u
        z[:6] += c.L[k] @ surprise
        z[:4] = c.F[k] @ _with_product(z) + c.B[k] @ u
        z[6:] = u
        self.made += 1
        self._go_to(k + 1)
        return None if self.period == len(c.F) else self._segment()

    def _go_to(self, begin: int) -> None:
        """Proceed to a period or a cheaper interchangeable one; coast on until at rest."""
        c, here, K = self.control, self.z, len(self.control.F)
        late = self.made >= LONGEST * K
        moves = abs(c.speed[begin] + here[3]) > c.rest
        best = math.inf
        for k in range(K + 1):
            alike = c.group[begin] and c.group[k] == c.group[begin] and (k > begin or not late)
            if begin == c.hold + 1 and moves and not late:
                if k != c.hold:
                    continue
            elif k != begin and not alike:
                continue
            z = here.copy()
            pose = moved(c.place[begin], np.array([0, here[2], here[0], here[1]]))
            z[:3] = apart(pose, c.place[k])
            z[3] += c.speed[begin] - c.speed[k]
            whole = _coasted(z)
            cost = float(whole @ c.value[k] @ whole) + PERIOD * (K - k)
            if cost < best:
                best, self.period, self.z = cost, k, z

    def _segment(self) -> Array:
        c, k = self.control, self.period
        u = c.command.segments[:, k].copy()
        u[:2] += self.u
        wanted = u[3:5] - c.gain[k] @ _coasted(self.z)
        u[3:5] = within(u, wanted, c.limits)
        self.u = u[3:5] - c.command.segments[3:5, k]
        return u


def _with_product(z: Array) -> Array:
    """z and v times the lack of friction."""
    return np.append(z, z[3] * z[4])


def _coasted(z: Array) -> Array:
    """(z, 1) with the speed replaced by that from which the nominal robot would coast as far:
    coasting distance goes as 1/friction, and so does the effect of the lack of friction."""
    far = 1 / max(1 - z[4], SLIPPERY)
    return np.array([*z[:3], z[3] * far, far - 1, *z[5:], 1.0])


def within(u: Array, wanted: Array, limits: Array) -> Array:
    """The amplitude and offset at the end of a segment, closest to those wanted, for which angle,
    rate and acceleration are within limits all along it: first the offset, as far as an amplitude
    exists for it, then the amplitude."""
    s = np.arange(LOOKS + 1) / LOOKS
    most = MARGIN * np.repeat(limits, LOOKS + 1)

    def path(A0: float, o0: float, A1: float, o1: float) -> Any:
        part = (A0, o0, u[2], A1, o1, u[5], u[6], u[7])
        return np.concatenate(blended(s, part, np.sin, np.cos))

    # The path is linear in the four.
    given, by_A, by_o = path(u[0], u[1], 0, 0), path(0, 0, 1, 0), path(0, 0, 0, 1)
    o1, A1 = u[1], 0.0
    for part in range(WAYS_BACK, -1, -1):
        o1 = u[1] + (wanted[1] - u[1]) * part / WAYS_BACK
        rest, slope = given + o1 * by_o, np.where(np.abs(by_A) < 1e-9, 1e-9, by_A)
        ends = (most - rest) / slope, (-most - rest) / slope
        low, high = max(0.0, float(np.minimum(*ends).max())), float(np.maximum(*ends).min())
        A1 = max(0.0, min(max(wanted[0], low), high))
        if low <= high:
            break
    return np.array([A1, o1])
