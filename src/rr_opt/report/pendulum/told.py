"""What was found in a recorded pendulum, whichever way it was cut into parts."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from rr_opt.diagnose.diagnosis import Diagnosis, Estimate, Misfit


@dataclass(frozen=True)
class Cut:
    """A diagnosis of the recording in parts, of which some are held out (numbered from 1).

    terms  all published terms fitted by simulation error, needed or not
    """

    parts: int
    held_out: tuple[int, ...]
    found: Diagnosis
    terms: Mapping[str, Estimate]


@dataclass(frozen=True)
class Told:
    """What the page, the figure and the record show; the first of `cuts` is shown.

    sigma      of the angle, rad: what of it is faster than `rigid`, Hz
    factor     within which the published values were believed
    values     as published;  elsewhere  in the lab's other files;  atan  factor of atan(100 w), N m
    published  misfit of the published model in the first cut
    torque_error  white error of the torque's samples that would leave the misfit found, N m
    regressed  inertia by linear regression, by cutoff of the low pass, Hz
    """

    digest: str
    sigma: float
    rigid: float
    factor: float
    values: Mapping[str, float]
    elsewhere: Mapping[str, float]
    atan: float
    published: Sequence[Misfit]
    torque_error: float
    regressed: Mapping[float, float]
    cuts: Sequence[Cut]


WORDS = {
    "J": "inertia, kg m²",
    "ml": "mass times length, kg m",
    "b": "viscous friction, N m s",
    "coulomb_friction.torque": "Coulomb friction, N m",
    "torque_offset.torque": "torque offset, N m",
}


def rms_of(parts: Sequence[Misfit]) -> float:
    """Over all samples, in sigma."""
    return float(np.sqrt(np.mean(np.concatenate([one.residuals.ravel() for one in parts]) ** 2)))


def record(told: Told) -> Mapping[str, Any]:
    """Everything as JSON."""
    return {
        "data_sha256": told.digest,
        "sigma_rad": told.sigma,
        "published": told.values,
        "published_rms_sigma": {one.recording: one.rms for one in told.published},
        "torque_error_Nm": told.torque_error,
        "inertia_by_regression": {f"{cutoff:g} Hz": J for cutoff, J in told.regressed.items()},
        "cuts": [_cut(one) for one in told.cuts],
    }


def _cut(one: Cut) -> Mapping[str, Any]:
    return {
        "parts": one.parts,
        "held_out": one.held_out,
        "verdict": one.found.verdict,
        "summary": one.found.summary,
        "findings": [asdict(finding) for finding in one.found.findings],
        "parameters": {name: asdict(value) for name, value in one.found.parameters.items()},
        "rms_sigma": {part.recording: part.rms for part in one.found.final},
        "tried": [
            {"effects": tried.effects, "fit": tried.fit, "score": tried.score, **tried.values}
            for tried in one.found.tried
        ],
        "published_terms": {name: asdict(value) for name, value in one.terms.items()},
    }
