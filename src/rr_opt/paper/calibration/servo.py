"""The angle that the servo makes of a commanded sine, in steady motion.

exact       the command
lagging     a first-order lag: smaller by sqrt(1 + (tau omega)^2), and later, which does not
            change a mean speed
limited     dphi/dt = R tanh((command - phi)/(R tau)): it closes in on the command like a lag of
            tau, but no faster than R. Told to go faster it runs at R all the time, and the angle
            becomes a triangle of amplitude R T/4, whatever was commanded.
"""

from __future__ import annotations

import math
from functools import lru_cache
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from rr_opt.paper.printed import TABLE_1

Array = NDArray[np.float64]

RATE_LIMIT = TABLE_1["greatest rate dphi/dt"].value * math.pi / 30
"""Table 1's 30 rpm, rad/s."""

CLOSING = 0.02
"""tau of the limited servo, s: assumed, short beside the periods; it rounds the triangle's
corners, where a servo without it would have to reverse within no time."""

_LEVELS = np.linspace(0.0, 1.4, 57)
"""Commanded amplitudes between which the limited servo is interpolated, rad."""
_PERIODS, _STEPS_PER_SAMPLE = 12, 8


class Angle(NamedTuple):
    """phi, its rate and its acceleration at n samples of half a period, (n, G); rad, s."""

    phi: Array
    rate: Array
    bend: Array


def sine(amplitude: Array, period: Array, n: int) -> Angle:
    """The command, sampled in the middle of n steps; amplitude (rad), period (s), (G,)."""
    theta = (np.arange(n)[:, None] + 0.5) * math.pi / n
    omega = 2 * math.pi / period
    swing = amplitude * np.sin(theta)
    return Angle(swing, amplitude * omega * np.cos(theta), -(omega**2) * swing)


def lagging(amplitude: Array, period: Array, lag: Array, n: int) -> Angle:
    """What a first-order lag (s, (G,)) leaves of the command."""
    return sine(amplitude / np.hypot(1.0, lag * 2 * math.pi / period), period, n)


def limited(amplitude: Array, period: Array, n: int) -> Angle:
    """What the limited servo makes of it; amplitudes up to 1.4 rad."""
    parts = np.empty((3, n, len(amplitude)))
    at = amplitude / _LEVELS[1]
    below = np.clip(at.astype(int), 0, len(_LEVELS) - 2)
    above = at - below
    for T in np.unique(period):
        here = period == T
        table = _response(float(T), n)
        low, share = below[here], above[here]
        parts[:, :, here] = table[:, :, low] * (1 - share) + table[:, :, low + 1] * share
    return Angle(*parts)


@lru_cache
def _response(period: float, n: int) -> Array:
    """phi, rate and acceleration (3, n, levels) of half a steady period, by classical RK4."""
    omega, steps = 2 * math.pi / period, n * _STEPS_PER_SAMPLE
    h = period / 2 / steps

    def rate(t: float, phi: Array) -> Array:
        return RATE_LIMIT * np.tanh((_LEVELS * math.sin(omega * t) - phi) / (RATE_LIMIT * CLOSING))

    phi, found = np.zeros_like(_LEVELS), np.empty((3, n, len(_LEVELS)))
    half_periods = 2 * _PERIODS
    for half in range(half_periods):
        for step in range(steps):
            t = half * period / 2 + step * h
            k1 = rate(t, phi)
            if half == half_periods - 1 and step % _STEPS_PER_SAMPLE == _STEPS_PER_SAMPLE // 2:
                share = 1 - (k1 / RATE_LIMIT) ** 2
                bend = share * (_LEVELS * omega * math.cos(omega * t) - k1) / CLOSING
                found[:, step // _STEPS_PER_SAMPLE] = phi, k1, bend
            k2 = rate(t + h / 2, phi + h / 2 * k1)
            k3 = rate(t + h / 2, phi + h / 2 * k2)
            phi = phi + h / 6 * (k1 + 2 * k2 + 2 * k3 + rate(t + h, phi + h * k3))
    # The last half period is a second half: its mirror image is the first.
    return -found
