"""Offset and drift of the angle's clock against that of the command.

A pure delay of the servo and a late clock are the same in a recording: both shift phi against its
command by the same time at every instant. Only a start from rest, or a delay that is not pure (a
lag, which also makes the angle smaller), can distinguish them.

phi recorded at t is matched with a reference, the command or the servo's log, at the time

    u = t + offset + drift (t - t_mid),   phi = bias + scale (g(u) - mean g)

by nonlinear least squares. Scale and bias are free, as a servo that lags also moves less. The
covariance is the sandwich estimator with Bartlett's weights over lags (W. K. Newey and K. D. West,
Econometrica 55, 1987, pp. 703-708), so that the residual may be coloured.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from scipy.optimize import least_squares

from rr_opt.array import Array
from rr_opt.model.experiment import Experiment, Recording
from rr_opt.model.gait import Gait
from rr_opt.recordings.warnings import notice

Reference = Callable[[Array], tuple[Array, Array]]
"""The reference and its rate at times (m,), rad and rad/s; NaN where it is not known."""

_FEWEST = 20
COVERED = 1.959964
"""Standard deviations on either side of 95 %."""


@dataclass(frozen=True)
class ClockShift:
    """Another clock's time is t + offset + drift (t - t_mid).

    offset, drift  s, and s per s
    sigma          their standard deviations, and those of further unknowns of a subclass
    t_mid          the middle of the samples that were used, s
    """

    offset: float
    drift: float
    sigma: tuple[float, ...]
    t_mid: float

    def interval(self, which: int = 0) -> tuple[float, float]:
        """95 % interval of offset (0), drift (1) or, of a fit, scale (2) or bias (3)."""
        value = getattr(self, ("offset", "drift", "scale", "bias")[which])
        half = COVERED * self.sigma[which]
        return value - half, value + half


@dataclass(frozen=True)
class ClockFit(ClockShift):
    """The shift to the reference's clock; its sigma has scale and bias, too.

    scale, bias  of phi against the reference; 1, and rad
    residual     root mean square of the residual, rad
    samples      how many were used
    """

    scale: float
    bias: float
    residual: float
    samples: int


def clock_fit(t: Array, phi: Array, reference: Reference, offset: float) -> ClockFit | None:
    """The fit that starts from an offset, s; None if there is too little to fit.

    t, phi: (n,), s and rad, NaN where there is no sample.
    """
    known = np.isfinite(phi) & np.isfinite(reference(t + offset)[0])
    if known.sum() < _FEWEST:
        return None
    t, phi = t[known], phi[known]
    t_mid = float((t[0] + t[-1]) / 2)
    since = t - t_mid
    # p[0] is what is added to it: steps are judged relative to p, and an offset may be a date.
    near = t + offset
    middle = float(np.nanmean(reference(near)[0]))

    def off(p: Array) -> Array:
        g, _ = reference(near + p[0] + p[1] * since)
        return np.nan_to_num(p[3] + middle + p[2] * (g - middle) - phi)

    def slopes(p: Array) -> Array:
        g, rate = reference(near + p[0] + p[1] * since)
        outside = ~np.isfinite(g)
        J = np.stack([p[2] * rate, p[2] * rate * since, g - middle, np.ones_like(g)], 1)
        J[outside] = 0.0
        return J

    size = float(np.ptp(phi))
    if not size > 0:
        return None
    start = [0.0, 0.0, 1.0, 0.0]
    found = least_squares(off, start, slopes, method="lm", x_scale="jac")  # type: ignore[arg-type]
    left, J = off(found.x), slopes(found.x)
    variances = _variances(J, left)
    if variances is None:
        return None
    more, drift, scale, bias = found.x.tolist()
    sigma, rms = tuple(np.sqrt(variances).tolist()), float(np.sqrt(np.mean(left**2)))
    return ClockFit(offset + more, drift, sigma, t_mid, scale, bias, rms, len(t))


def _variances(J: Array, left: Array) -> Array | None:
    """Variances of the unknowns by the sandwich estimator, but no less than for white noise."""
    scale = np.linalg.norm(J, axis=0)
    if not (scale > 0).all():
        return None
    unit = J / scale
    information = unit.T @ unit
    if np.linalg.cond(information) > 1e10:
        return None
    score = unit * left[:, None]
    lags = min(round(1.5 * len(left) ** (1 / 3)), len(left) // 4)
    meat = score.T @ score
    for lag in range(1, lags + 1):
        later = score[lag:].T @ score[:-lag]
        meat += (1 - lag / (lags + 1)) * (later + later.T)
    bread = np.linalg.inv(information)
    white = np.diag(bread) * float(left @ left) / (len(left) - len(scale))
    # The estimate over lags falls short by chance as often as it exceeds: the larger is taken.
    return np.maximum(np.diag(bread @ meat @ bread), white) / scale**2


_SHIFTS = 64


def command_reference(gait: Gait, *, from_rest: bool) -> Reference:
    """The command and its rate; from_rest: its first angle is held before its time 0."""

    def reference(u: Array) -> tuple[Array, Array]:
        if not from_rest:
            return gait.angle(u), gait.rate(u)
        begun = np.maximum(u, 0.0)
        return gait.angle(begun), np.where(u < 0, 0.0, gait.rate(begun))

    return reference


def against_command(
    t: Array, phi: Array, gait: Gait, *, from_rest: bool = False
) -> ClockFit | None:
    """phi (n,), rad, seen at t (n,), s, against its command; None if it cannot be matched.

    The offset is sought within half a period to either side. A negative one is a phi that lags.
    from_rest: the command begins at its time 0, and its first angle is held before.
    """
    reference = command_reference(gait, from_rest=from_rest)
    known = np.flatnonzero(np.isfinite(phi))
    known = known[:: max(1, len(known) // 2000)]
    if len(known) < 2 or np.ptp(phi[known]) == 0:
        return None
    seen = phi[known] - phi[known].mean()

    def alike(shift: float) -> float:
        g, _ = reference(t[known] + shift)
        g = g - g.mean()
        return float(seen @ g) / max(float(np.linalg.norm(g)), 1e-300)

    shifts = (np.arange(_SHIFTS) / _SHIFTS - 0.5) * gait.period
    return clock_fit(t, phi, reference, max(shifts.tolist(), key=alike))


RUNS_OFF = 1e-5
"""A smaller drift is negligible, s per s."""
_CERTAIN = 5.0
"""Standard errors of the drift, also over recordings, beyond which times are corrected."""


def at_commanded_rate(experiment: Experiment) -> Experiment:
    """The experiment with its recordings' times multiplied so that phi has the command's period.

    Whatever its errors, a servo keeps its command's period, so a recorder's clock that runs fast or
    slow shows, to a few millionths. One recorder is assumed for all runs.
    """
    fits = [
        against_command(one.t, one.data("phi"), run.gait, from_rest=run.start == "rest")
        for run in experiment.runs
        for one in [run.recording]
    ]
    drifts = np.array([fit.drift for fit in fits if fit])
    if not len(drifts):
        return experiment
    weights = np.array([fit.sigma[1] for fit in fits if fit]) ** -2.0
    drift = float(np.average(drifts, weights=weights))
    scatter = float(np.average((drifts - drift) ** 2, weights=weights))
    error = math.sqrt(1 / weights.sum() + scatter / len(drifts))
    if abs(drift) < max(RUNS_OFF, _CERTAIN * error):
        return experiment
    said = notice("clock.rate", drift=1e2 * drift)

    def corrected(recording: Recording) -> Recording:
        doubts = (*recording.doubts, said)
        return replace(recording, t=recording.t * (1 + drift), doubts=doubts)

    runs = (replace(run, recording=corrected(run.recording)) for run in experiment.runs)
    return replace(experiment, runs=tuple(runs))
