"""A servo that follows its command late and smaller: tau dphi/dt = command - phi.

The command's period is a Fourier series, which the lag answers term by term with 1/(1 + i w tau).
From standing still the answer to the periodic command, and exp(-t/tau) of what is missing at t = 0.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from rr_opt.physics.drive import Array, Drive, FreeJoint
from rr_opt.physics.effects.effect import Effect, Parameter, Port

_SAMPLES = 512
_NEGLIGIBLE = 1e-10
"""A term so small, relative to the largest, is left out."""


def _actuate(told: Drive, values: Mapping[str, float], _: FreeJoint | None = None) -> Drive:
    tau = values["tau"]
    if tau <= 0:
        return told
    grid = told.period * np.arange(_SAMPLES) / _SAMPLES
    terms = np.fft.rfft(told.at(grid)[0]) / _SAMPLES
    terms[1:] *= 2
    kept = np.flatnonzero(np.abs(terms) > _NEGLIGIBLE * np.abs(terms).max())
    omega = 2 * np.pi * kept / told.period
    gains = terms[kept] / (1 + 1j * omega * tau)
    powers = np.array([np.ones_like(omega), 1j * omega, -(omega**2)])

    def steady(t: Array) -> Array:
        turning = np.exp(1j * omega[:, None] * np.asarray(t)[None])
        return ((powers * gains) @ turning).real

    if not told.rest:
        return replace(told, at=steady)
    before = told.at(np.array([-1.0]))[0, 0]
    missing = before - steady(np.array([0.0]))[0, 0]

    def from_rest(t: Array) -> Array:
        fading = missing * np.exp(-np.maximum(t, 0.0) / tau)
        path = steady(t) + np.array([fading, -fading / tau, fading / tau**2])
        return np.where(np.asarray(t) < 0, np.array([[before], [0.0], [0.0]]), path)

    return replace(told, at=from_rest)


EFFECT = Effect(
    name="servo_lag",
    family="actuation",
    port=Port.ACTUATION,
    parameters=(Parameter("tau", "s", (0.0, 0.5), 0.02),),
    sentence="The servo follows its command late, and with a smaller swing.",
    actuate=_actuate,
)
