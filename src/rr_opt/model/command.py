"""The joint angle of a whole drive: a sine whose amplitude, offset and frequency change smoothly.

Knots hold amplitude A, offset o and frequency omega. From knot to knot, over the duration D, the
frequency changes linearly and the other two by h = 3 s^2 - 2 s^3, s = t/D:

    phi = o0 + (o1 - o0) h + (A0 + (A1 - A0) h) sin theta
    theta = theta0 + D s (omega0 + (omega1 - omega0) s/2)

Angle and rate are continuous; the acceleration jumps at knots. Between two equal knots the joint
makes a plain sine; with the amplitude 0 it stands still and the robot coasts.
"""

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from rr_opt.array import Array


def blended(s: Any, segment: Any, sin: Any, cos: Any) -> tuple[Any, Any, Any]:
    """phi (rad), dphi/dt and d2phi/dt2 at s in [0, 1] of a segment (A0, o0, omega0, A1, o1, omega1,
    theta0, D): of numbers, arrays or symbols, with the sine and cosine that go with them."""
    A0, o0, w0, A1, o1, w1, theta0, D = segment
    h, dh, ddh = s * s * (3 - 2 * s), 6 * s * (1 - s) / D, 6 * (1 - 2 * s) / (D * D)
    w = w0 + (w1 - w0) * s
    theta = theta0 + D * s * (w0 + w) / 2
    wave, along = sin(theta), cos(theta)
    A, dA, ddA = A0 + (A1 - A0) * h, (A1 - A0) * dh, (A1 - A0) * ddh
    phi = o0 + (o1 - o0) * h + A * wave
    dphi = (o1 - o0) * dh + dA * wave + A * w * along
    bend = (w1 - w0) / D * along - w * w * wave
    return phi, dphi, (o1 - o0) * ddh + ddA * wave + 2 * dA * w * along + A * bend


@dataclass(frozen=True)
class Command:
    """phi(t) from t = 0, where the joint stands still, through all knots. After the last one it
    goes on with that knot's sine, which is none if its amplitude is 0.

    durations  (N,) s, from knot to knot
    knots      (3, N + 1): amplitude (rad), offset (rad), frequency omega (rad/s)
    """

    durations: Array
    knots: Array

    @cached_property
    def times(self) -> Array:
        """Times of the knots, s, (N + 1,)."""
        return np.concatenate([[0.0], np.cumsum(self.durations)])

    @property
    def seconds(self) -> float:
        """Time of the last knot, s."""
        return float(self.times[-1])

    @cached_property
    def segments(self) -> Array:
        """What `blended` needs of each segment, (8, N)."""
        first, last = self.knots[:, :-1], self.knots[:, 1:]
        turned = np.cumsum(self.durations * (first[2] + last[2]) / 2)
        theta = np.concatenate([[0.0], turned[:-1]])
        return np.vstack([first, last, theta, self.durations])

    def at(self, t: ArrayLike) -> Array:
        """phi, dphi/dt, d2phi/dt2 (3, n) at the times t (n,), s; at a jump, the value after it."""
        t = np.asarray(t, float)
        k = np.clip(np.searchsorted(self.times, t, side="right") - 1, 0, len(self.durations) - 1)
        segment = self.segments[:, k]
        after = t > self.times[-1]
        s = np.where(after, 1.0, np.maximum(t - self.times[k], 0.0) / segment[7])
        path = np.array(blended(s, segment, np.sin, np.cos))
        A, o, w = self.knots[:, -1]
        theta = np.dot(self.durations, self.knots[2, :-1] + self.knots[2, 1:]) / 2
        theta = theta + w * (t[after] - self.times[-1])
        path[:, after] = [
            o + A * np.sin(theta), A * w * np.cos(theta), -A * w * w * np.sin(theta)
        ]  # fmt: skip
        path[1:, t < 0] = 0.0
        return path

    def angle(self, t: ArrayLike) -> Array:
        """phi, rad, in the shape of t (s); before t = 0 that at t = 0."""
        return self.at(np.ravel(t))[0].reshape(np.shape(t))
