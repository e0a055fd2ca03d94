"""Gaits: the angle phi(t) between the platforms that the servo is commanded to follow."""

from __future__ import annotations

import math
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rr_opt.array import Array
from rr_opt.model.fields import SI, Numbers, Series, data, declared
from rr_opt.units import Number

AMPLITUDE = Number("rad", "30 deg", at_least=0)
PERIOD = Number("s", "1.2 s", at_least=0.01)
"""No servo follows 100 Hz: a shorter period is a slip of the unit."""
OFFSET = Number("rad", "10 deg")
_ANGLE = Number("rad", "0.5")


@data
class SineGait:
    """phi(t) = amplitude sin(2 pi t/period) + offset (the paper's equation 5).

    amplitude (alpha) and offset (phi0) in rad, period (T) in s.
    """

    amplitude: SI = declared(AMPLITUDE, "amplitude, rad.")
    period: SI = declared(PERIOD, "period, s.")
    offset: SI = declared(OFFSET, "offset, rad.", default=0.0)

    shape = "sine"
    pieces = 1

    @property
    def angular_frequency(self) -> float:
        """2 pi/T, rad/s."""
        return 2 * math.pi / self.period

    @property
    def peak_angle(self) -> float:
        """Largest |phi| over a period, rad."""
        return abs(self.offset) + abs(self.amplitude)

    @property
    def peak_rate(self) -> float:
        """Largest |dphi/dt| over a period, rad/s."""
        return abs(self.amplitude) * self.angular_frequency

    def resized(self, amplitude: float, period: float, offset: float) -> SineGait:
        """The sine with these values."""
        return SineGait(amplitude, period, offset)

    def angle(self, t: ArrayLike) -> Array:
        """phi, rad, in the shape of t (s)."""
        return self.amplitude * np.sin(self.angular_frequency * np.asarray(t, float)) + self.offset

    def rate(self, t: ArrayLike) -> Array:
        """dphi/dt, rad/s, in the shape of t (s)."""
        turn = self.angular_frequency * np.asarray(t, float)
        return self.amplitude * self.angular_frequency * np.cos(turn)

    def acceleration(self, t: ArrayLike) -> Array:
        """d2phi/dt2, rad/s2, in the shape of t (s)."""
        turn = self.angular_frequency * np.asarray(t, float)
        return -self.amplitude * self.angular_frequency**2 * np.sin(turn)


_SAMPLES = 64
"""Samples per harmonic among which an extreme is looked for."""


@data
class FourierGait:
    """phi(t) = offset + sum over n of sines[n-1] sin(2 pi n t/T) + cosines[n-1] cos(2 pi n t/T).

    period (T) in s, offset (phi0), sines (alpha_n) and cosines (beta_n), as many of each, in rad.
    """

    period: SI = declared(PERIOD, "period, s.")
    offset: SI = declared(OFFSET, "offset, rad.")
    sines: Numbers = declared(Series(_ANGLE), "the sizes of the sines, rad, one for each harmonic.")
    cosines: Numbers = declared(
        Series(_ANGLE), "the sizes of the cosines, rad, one for each harmonic."
    )

    shape = "fourier"
    pieces = 1

    @property
    def harmonics(self) -> int:
        """How many."""
        return len(self.sines)

    @property
    def amplitude(self) -> float:
        """Largest |phi - phi0| over a period, rad."""
        return self._peak(0, 0.0)

    @property
    def peak_angle(self) -> float:
        """Largest |phi| over a period, rad."""
        return self._peak(0, self.offset)

    @property
    def peak_rate(self) -> float:
        """Largest |dphi/dt| over a period, rad/s."""
        return self._peak(1, 0.0)

    def resized(self, amplitude: float, period: float, offset: float) -> FourierGait:
        """The same shape with another amplitude (rad), period (s) and offset (rad)."""
        factor = amplitude / self.amplitude
        sines, cosines = (
            tuple(factor * size for size in sizes) for sizes in (self.sines, self.cosines)
        )
        return FourierGait(period, offset, sines, cosines)

    def angle(self, t: ArrayLike) -> Array:
        """phi, rad, in the shape of t (s)."""
        return self.offset + self._derivative(0, t)

    def rate(self, t: ArrayLike) -> Array:
        """dphi/dt, rad/s, in the shape of t (s)."""
        return self._derivative(1, t)

    def acceleration(self, t: ArrayLike) -> Array:
        """d2phi/dt2, rad/s2, in the shape of t (s)."""
        return self._derivative(2, t)

    def _derivative(self, order: int, t: ArrayLike) -> Array:
        """The order-th derivative of phi - phi0: each one turns a harmonic by a quarter."""
        t = np.asarray(t, float)
        total = np.zeros_like(t)
        for n, (sine, cosine) in enumerate(zip(self.sines, self.cosines, strict=True), 1):
            omega = 2 * math.pi * n / self.period
            turned = omega * t + order * math.pi / 2
            total = total + omega**order * (sine * np.sin(turned) + cosine * np.cos(turned))
        return total

    def _peak(self, order: int, shift: float) -> float:
        """Largest |shift + derivative|: sampled, then by Newton's method on its own slope."""
        t = np.arange(_SAMPLES * self.harmonics) * self.period / (_SAMPLES * self.harmonics)
        size = np.abs(shift + self._derivative(order, t))
        at = t[size >= np.maximum(np.roll(size, 1), np.roll(size, -1))]
        for _ in range(4):
            slope, bend = (self._derivative(order + k, at) for k in (1, 2))
            step = np.where(np.abs(bend) > 0, slope / np.where(bend == 0, 1.0, bend), 0.0)
            at = at - np.clip(step, -t[1], t[1])
        peaks = np.abs(shift + self._derivative(order, at))
        return float(max(size.max(), peaks.max(initial=0.0)))


@data
class FreeGait:
    """phi(t) with a constant acceleration on each of N equal intervals of the period.

    period (T) in s; angle0 and rate0, phi (rad) and dphi/dt (rad/s) at t = 0; accelerations
    (N), d2phi/dt2 on each interval, rad/s2. They have to close: what is left after a period, by
    rounding, jumps where the next begins.
    """

    period: SI = declared(PERIOD, "period, s.")
    angle0: SI = declared(_ANGLE, "phi at the start, rad.")
    rate0: SI = declared(Number("rad/s", "1.5"), "dphi/dt at the start, rad/s.")
    accelerations: Numbers = declared(
        Series(Number("rad/s^2", "0.1"), least=2), "d2phi/dt2 on each interval, rad/s2."
    )

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


Gait = SineGait | FourierGait | FreeGait
"""A periodic phi(t), whatever its shape: `shape`, `period` (T, s), `offset` (phi0, the mean of phi,
rad), `amplitude` (largest |phi - phi0|, rad), `peak_angle` and `peak_rate` (of |phi| and
|dphi/dt|); `pieces`, into how many equal parts of the period the jumps of the acceleration cut it,
1 where phi is smooth; `angle`, `rate` and `acceleration` at times t (s); and `resized`."""
