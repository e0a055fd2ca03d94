"""Confidence intervals of fitted values, and which nominal values are wrong.

The likelihood's information H is one estimate of the covariance of the scores; their scatter over
recordings is another, which does not rest on the model being right (Huber 1967, White 1982). With
few recordings the second is itself uncertain, so both are averaged with equal weight:

    V = H^-1 (P + (B_model + B_recordings)/2) H^-1,    P the prior's precision.
"""

import math
from collections.abc import Mapping
from dataclasses import replace

import numpy as np
from scipy.special import ndtri

from rr_opt.array import Array
from rr_opt.sysid.diagnosis import Estimate
from rr_opt.sysid.estimation import Fit, fitted
from rr_opt.sysid.model import Quantity
from rr_opt.sysid.settings import SETTINGS

_Z = -float(ndtri(0.025))


def covariance(fit: Fit) -> Array:
    """Covariance of the scaled quantities (nq, nq); see above."""
    every = list(fit.marginal.values())
    prior = np.diag(fit.problem.prior)
    model = sum((e.H for e in every), np.zeros_like(prior))
    C = np.linalg.pinv(prior + model, hermitian=True)
    scores = np.array([e.g for e in every])
    if len(scores) > 1:
        off = scores - scores.mean(axis=0)
        model = (model + off.T @ off * len(scores) / (len(scores) - 1)) / 2
    return np.asarray(C @ (prior + model) @ C, float)


def estimates(fit: Fit) -> dict[str, Estimate]:
    """Every fitted quantity with its 95 % interval by the fit alone."""
    spread = np.sqrt(np.maximum(np.diag(covariance(fit)), 0.0))
    out = {}
    for q, s in zip(fit.problem.quantities, spread, strict=True):
        value = float(fit.values[q.name])
        half = _Z * math.hypot(float(s) * q.scale, q.form_error * value)
        half = half if math.isfinite(half) else math.inf
        out[q.name] = Estimate(value, max(value - half, q.low), min(value + half, q.high), q.unit)
    return out


def joint(own: Mapping[str, Estimate], other: Mapping[str, Estimate]) -> dict[str, Estimate]:
    """Estimates with intervals that also cover those of another fit of the same quantities. A loss
    may have several minima: the curvature at one does not show another, but other data may."""
    return {
        name: replace(one, low=min(one.low, other[name].low), high=max(one.high, other[name].high))
        for name, one in own.items()
    }


def surprises(fit: Fit) -> Array:
    """How far each quantity is from its nominal value: a standard normal if that is right.

    With u, s a parameter's value and standard deviation in prior standard deviations, the data
    alone put it at u/(1 - s^2); u/sqrt(1 - s^2) is the deleted residual. For a value known only to
    within a factor it is the distance in its own standard deviations.
    """
    quantities = fit.problem.quantities
    if not quantities:
        return np.zeros(0)
    H, _, _ = fit.information()
    s = np.sqrt(np.clip(np.diag(np.linalg.pinv(H, hermitian=True)), 1e-300, None))
    usual = np.sqrt(np.maximum(1 - np.minimum(s, 1.0) ** 2, 1e-300))
    own = np.array([q.free for q in quantities])
    scale = np.where(own, np.sqrt(np.maximum(np.diag(covariance(fit)), 1e-300)), usual)
    return np.where([q.known for q in quantities], fit.u / scale, 0.0)


def limit(fit: Fit) -> float:
    """Threshold of |surprise|, corrected for testing all values at once."""
    known = sum(q.known for q in fit.problem.quantities)
    return -float(ndtri(SETTINGS.false_alarm / (2 * max(known, 1))))


def wrong(fit: Fit) -> list[Quantity]:
    """The parameters whose nominal values are wrong."""
    over = np.abs(surprises(fit)) > limit(fit)
    return [q for q, off in zip(fit.problem.quantities, over, strict=True) if off]


def released(fit: Fit) -> Fit:
    """The fit without the priors of values that are certainly wrong, released one at a time: priors
    spread one large deviation over several values, so each wrong value biases others.

    Stepwise: a value that, released, is not certainly wrong gets its prior back, or it would excuse
    others unnoticed. This may be an earlier one.
    """
    nominal = {q.name: q for q in fit.problem.quantities}
    once: list[str] = []
    size = _sizes(fit)
    while len(once) < SETTINGS.most_effects:
        held = [q.name for q in fit.problem.quantities if not q.free and q.name not in once]
        worst = max(held, key=size.__getitem__, default="")
        if not held or size[worst] <= limit(fit):
            break
        once.append(worst)
        own = nominal[worst]
        fit = _with(fit, replace(own, scale=own.scale * SETTINGS.effect_prior, free=True))
        size = _sizes(fit)
        doubtful = [q.name for q in fit.problem.quantities if q.free and q.name in once]
        least = min(doubtful, key=size.__getitem__)
        if size[least] <= limit(fit):
            fit = _with(fit, nominal[least])
            size = _sizes(fit)
    return fit


def instead_of(fit: Fit, name: str) -> tuple[str, ...]:
    """Values that, wrong instead of a released one, would explain the recordings about as well, the
    likeliest first; none for a value that was not released.

    By the linearisation: the released value gets its prior back, and the other one's is widened as
    much, so that the volume of both is the same and the losses compare.
    """
    stated = {q.name for q in fit.problem.model.parameters if not q.free}
    held = [q.name for q in fit.problem.quantities if q.name in stated and not q.free]
    if name not in stated or name in held:
        return ()
    H, g, _ = fit.information()
    wide = SETTINGS.effect_prior**2

    def least(change: Mapping[str, float]) -> float:
        """The change of the loss with these changes of the prior's precisions."""
        D = np.array([change.get(one, 0.0) for one in fit.problem.names])
        pull = g + D * fit.u
        return float(D @ fit.u**2 - pull @ np.linalg.pinv(H + np.diag(D), hermitian=True) @ pull)

    losses = {other: least({name: wide - 1, other: 1 / wide - 1}) for other in held}
    most = least({}) + 2 * SETTINGS.evidence
    return tuple(sorted((one for one in held if losses[one] < most), key=losses.__getitem__))


def _sizes(fit: Fit) -> dict[str, float]:
    return dict(zip(fit.problem.names, np.abs(surprises(fit)).tolist(), strict=True))


def _with(fit: Fit, quantity: Quantity) -> Fit:
    """The fit with another prior of a quantity."""
    every = fit.problem.quantities
    quantities = tuple(quantity if q.name == quantity.name else q for q in every)
    problem = replace(fit.problem, quantities=quantities)
    return fitted(problem, fit.values, fit.states, known=fit.linear)
