"""A servo that follows its command late and smaller: beta phi" + tau phi' + phi = command.

Without beta it is a lag of first order. The command's period is a Fourier series, which the lag
answers term by term with 1/(1 + i w tau - w^2 beta). From standing still the answer is that to the
periodic command, and what fades of where and how fast the servo would have to be at t = 0.
"""

from __future__ import annotations

import cmath
from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from rr_opt.array import Array
from rr_opt.effects.effect import Effect, Parameter, Port
from rr_opt.mechanics.drive import Drive, FreeJoint

_SAMPLES = 512
_FIRST_ORDER = 1e-6
"""A beta so small, in tau squared, fades before any step is done."""
_NEGLIGIBLE = 1e-10
"""A term so small, relative to the largest, is left out."""


def _actuate(told: Drive, values: Mapping[str, float], _: FreeJoint | None = None) -> Drive:
    tau, beta = values["tau"], values.get("beta", 0.0)
    if tau <= 0:
        return told
    grid = told.period * np.arange(_SAMPLES) / _SAMPLES
    terms = np.fft.rfft(told.at(grid)[0]) / _SAMPLES
    terms[1:] *= 2
    kept = np.flatnonzero(np.abs(terms) > _NEGLIGIBLE * np.abs(terms).max())
    omega = 2 * np.pi * kept / told.period
    gains = terms[kept] / (1 + 1j * omega * tau - omega**2 * beta)
    powers = np.array([np.ones_like(omega), 1j * omega, -(omega**2)])

    def steady(t: Array) -> Array:
        turning = np.exp(1j * omega[:, None] * np.asarray(t)[None])
        return ((powers * gains) @ turning).real

    if not told.rest:
        return replace(told, at=steady)
    before = told.at(np.array([-1.0]))[0, 0]
    angle, rate, _ = steady(np.array([0.0]))[:, 0]
    rates, amounts = _fading(tau, beta, before - angle, -rate)

    def from_rest(t: Array) -> Array:
        since = np.maximum(np.asarray(t, float), 0.0)
        fading = (amounts * rates ** np.arange(3)[:, None]) @ np.exp(rates[:, None] * since)
        return np.where(
            np.asarray(t) < 0, np.array([[before], [0.0], [0.0]]), steady(t) + fading.real
        )

    return replace(told, at=from_rest)


def _fading(tau: float, beta: float, missing: float, rate: float) -> tuple[Array, Array]:
    """How fast what is missing at t = 0 (rad, and its rate) fades (1/s), and how much of each."""
    if beta < _FIRST_ORDER * tau**2:
        return np.array([-1 / tau]), np.array([missing])
    # Where both fade alike they are told apart by a hair, which changes nothing that counts.
    apart = cmath.sqrt(tau**2 - 4 * beta) or 1e-6 * tau
    rates = np.array([-tau + apart, -tau - apart]) / (2 * beta)
    first = (rate - rates[1] * missing) / (rates[0] - rates[1])
    return rates, np.array([first, missing - first])


EFFECT = Effect(
    name="servo_lag",
    family="actuation",
    port=Port.ACTUATION,
    parameters=(
        Parameter("tau", "s", (0.0, 0.5), 0.02),
        Parameter("beta", "s^2", (0.0, 0.05), 2e-4),
    ),
    sentence="The servo follows its command late, and with a smaller swing.",
    actuate=_actuate,
    forms=(("tau",), ("tau", "beta")),
    # With beta = tau^2/2 the swing is as large as it was told, and only late.
    imitates=("clock_offset",),
)
