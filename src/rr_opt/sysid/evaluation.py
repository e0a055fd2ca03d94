"""Residuals of a model with given values on every recording, including held-out ones."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.special import chdtrc

from rr_opt.sysid.candidates import Candidate
from rr_opt.sysid.diagnosis import Misfit, Mismatch
from rr_opt.sysid.estimation import Fit, predicted
from rr_opt.sysid.model import Request


@dataclass(frozen=True)
class Evaluation:
    """Recordings simulated with given values, whole or in windows as long as the machine can be
    predicted; only initial states are fitted."""

    values: Mapping[str, float]
    misfits: tuple[Misfit, ...]

    @property
    def rms(self) -> float:
        """RMS in sigma over the held-out recordings; over all of them where none is held out."""
        held = [one for one in self.misfits if one.held_out] or list(self.misfits)
        return rms(held)

    @property
    def excess(self) -> float:
        """The same beyond the noise."""
        return math.sqrt(max(self.rms**2 - 1, 0.0))


def rms(misfits: Sequence[Misfit]) -> float:
    """RMS in sigma over all values."""
    every = np.concatenate([one.residuals.ravel() for one in misfits])
    return float(np.sqrt(np.nanmean(every**2)))


def mismatch(base: Candidate) -> Mismatch:
    """Whether the nominal model, its parameters fitted, leaves more than noise."""
    fit = base.fit
    misfit = fit.samples + sum(e.excess for e in fit.evidences.values())
    degrees = max(fit.samples - len(fit.problem.names), 1)
    return Mismatch(base.excess, float(chdtrc(degrees, misfit)))


def evaluation(fit: Fit, values: Mapping[str, float]) -> Evaluation:
    """Evaluate all runs of the fit's model, with its effects and these values."""
    model = fit.problem.model
    single = predicted(fit, range(len(model.runs)), values)
    return Evaluation(values, tuple(_misfit(single, k) for k in range(len(model.runs))))


def _misfit(fit: Fit, run: int) -> Misfit:
    model, data = fit.problem.model, fit.problem.model.runs[run]
    made = np.concatenate(
        [
            model.predicted(Request(one, fit.values, fit.states[one]), fit.effects)[
                : one.until - one.first
            ]
            for one in fit.problem.by_run[run]
        ]
    )
    r = (made - data.values) / data.sigma
    channels = {
        name: float(np.sqrt(np.nanmean(r[:, k] ** 2)))
        for k, name in enumerate(model.channels)
        if np.isfinite(r[:, k]).any()
    }
    total = float(np.sqrt(np.nanmean(r**2)))
    return Misfit(data.name, data.held_out, total, channels, data.t, made, r, data.sigma)
