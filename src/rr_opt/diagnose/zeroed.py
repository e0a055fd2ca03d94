"""Recordings told from the zeros that a fit found, where those may be off."""

from __future__ import annotations

from dataclasses import replace

from rr_opt.diagnose.fit import Fit
from rr_opt.diagnose.racer import RollerRacer
from rr_opt.diagnose.racer_quantities import ZEROS


def zeroed(racer: RollerRacer, fit: Fit) -> RollerRacer:
    """The racer with exact zeros, and recordings of psi and phi less those of the fit."""
    uncertainty = racer.experiment.uncertainty
    off = {name: fit.values.get(name, 0.0) for name in ZEROS.values() if name in uncertainty}
    if not off:
        return racer
    runs = []
    for run in racer.experiment.runs:
        values = dict(run.recording.values)
        for name, zero in off.items():
            channel = name.removesuffix("_zero")
            values[channel] = values[channel] - zero
        runs.append(replace(run, recording=replace(run.recording, values=values)))
    exact = {name: known for name, known in uncertainty.items() if name not in off}
    return RollerRacer(replace(racer.experiment, runs=tuple(runs), uncertainty=exact))
