"""A gait of no given shape: the servo's acceleration is one number on each of many intervals."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True)
class FreeGait:
    """phi(t) with a constant acceleration on each of N equal intervals of the period.

    period (T) in s; angle0 and rate0, phi (rad) and dphi/dt (rad/s) at t = 0; accelerations
    (N), d2phi/dt2 on each interval, rad/s2. They have to close: what is left after a period, by
    rounding, jumps where the next begins.
    """

    period: float
    angle0: float
    rate0: float
    accelerations: tuple[float, ...]

    shape = "free"

    @property
    def pieces(self) -> int:
        """How many intervals."""
        return len(self.accelerations)

    @property
    def step(self) -> float:
        """Length of an interval, s."""
        return self.period / self.pieces

    @cached_property
    def nodes(self) -> tuple[Array, Array]:
        """phi (rad) and dphi/dt (rad/s) where the intervals begin, and at the end, (N + 1,)."""
        h, u = self.step, np.array(self.accelerations)
        rates = self.rate0 + np.concatenate([[0.0], np.cumsum(h * u)])
        angles = self.angle0 + np.concatenate([[0.0], np.cumsum(h * rates[:-1] + h**2 * u / 2)])
        return angles, rates

    @property
    def offset(self) -> float:
        """phi0, the mean of phi over a period, rad."""
        angles, rates = self.nodes
        h, u = self.step, np.array(self.accelerations)
        return float(np.mean(angles[:-1] + h * rates[:-1] / 2 + h**2 * u / 6))

    @cached_property
    def extremes(self) -> tuple[float, float]:
        """Smallest and largest phi over a period, rad."""
        angles, rates = self.nodes
        u = np.array(self.accelerations)
        # Within an interval phi is extreme where the rate passes through zero.
        turns = rates[:-1] * rates[1:] < 0
        inner = angles[:-1][turns] - rates[:-1][turns] ** 2 / (2 * u[turns])
        every = np.concatenate([angles, inner])
        return float(every.min()), float(every.max())

    @property
    def amplitude(self) -> float:
        """Largest |phi - phi0| over a period, rad."""
        low, high = self.extremes
        return max(high - self.offset, self.offset - low)

    @property
    def peak_angle(self) -> float:
        """Largest |phi| over a period, rad."""
        low, high = self.extremes
        return max(high, -low)

    @property
    def peak_rate(self) -> float:
        """Largest |dphi/dt| over a period, rad/s."""
        return float(np.abs(self.nodes[1]).max())

    def resized(self, amplitude: float, period: float, offset: float) -> FreeGait:
        """The same shape with another amplitude (rad), period (s) and offset (rad)."""
        factor, speed = amplitude / self.amplitude, self.period / period
        return FreeGait(
            period,
            offset + factor * (self.angle0 - self.offset),
            factor * speed * self.rate0,
            tuple(factor * speed**2 * u for u in self.accelerations),
        )

    def angle(self, t: ArrayLike) -> Array:
        """phi, rad, in the shape of t (s)."""
        at, since = self._interval(t)
        angles, rates = self.nodes
        return angles[at] + since * (rates[at] + since * np.array(self.accelerations)[at] / 2)

    def rate(self, t: ArrayLike) -> Array:
        """dphi/dt, rad/s, in the shape of t (s)."""
        at, since = self._interval(t)
        return self.nodes[1][at] + since * np.array(self.accelerations)[at]

    def acceleration(self, t: ArrayLike) -> Array:
        """d2phi/dt2, rad/s2, in the shape of t (s); at a jump, the value after it."""
        return np.array(self.accelerations)[self._interval(t)[0]]

    def _interval(self, t: ArrayLike) -> tuple[NDArray[np.int_], Array]:
        """In which interval each t lies, and since when it does, s."""
        t = np.asarray(t, float) % self.period
        # A time that rounding puts just before a node belongs to the interval that begins there.
        at = np.floor(t / self.step + 1e-9).astype(int)
        return at % self.pieces, t - at * self.step
