"""Common to all diagnoses, for any machine: verdict, effects, message, diagnosis.json."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any, Generic, TypeVar

import numpy as np

from rr_opt.model.experiment import Experiment
from rr_opt.model.machine import MachineExperiment
from rr_opt.results.result import Result, picked
from rr_opt.sysid.diagnosis import Curve, Diagnosis, Estimate, Finding, Misfit, Residue

Diagnosed = TypeVar("Diagnosed", Experiment, MachineExperiment)


@dataclass(frozen=True, repr=False)
class Explained(Result, Generic[Diagnosed]):
    """The diagnosis of an experiment.

    name, sha256  of the input
    found         the whole diagnosis
    """

    FILE = "diagnosis.json"

    name: str
    sha256: str
    experiment: Diagnosed
    found: Diagnosis

    @property
    def verdict(self) -> str:
        """`consistent`, `parameters`, `missing_physics` or `unexplained`."""
        return self.found.verdict

    @property
    def effects(self) -> tuple[Finding, ...]:
        """The accepted effects, strongest first; for the verdict `parameters`, the parameters."""
        return tuple(self.found.findings)

    @property
    def message(self) -> str:
        """The diagnosis in a paragraph."""
        return self.found.summary

    @property
    def doubts(self) -> tuple[str, ...]:
        """Sentences on the recordings that were used, each with its recording's name."""
        return tuple(f"{run.name}: {doubt}" for run in self.experiment.runs for doubt in run.doubts)

    @property
    def warnings(self) -> tuple[str, ...]:
        """Suspicious features of the recordings."""
        return self.doubts

    @property
    def where(self) -> str:
        """Where the fault shows, in words; empty if unknown."""
        return self.found.where

    def _record(self) -> dict[str, Any]:
        found = self.found
        plan = found.next_experiment
        return {
            "name": self.name,
            **picked(found, "verdict summary"),
            "mismatch": {"rms_beyond_noise": found.mismatch.rms, "p_value": found.mismatch.p_value},
            "location": {
                "channel": found.channel,
                "where": self.where,
                "evidence": [
                    {
                        "test": stage.name,
                        **picked(stage, "channel statistic p_value size guilty where"),
                        "curves": [_curve(curve) for curve in stage.curves],
                    }
                    for stage in found.stages
                ],
            },
            "effects": [_finding(each, found.verdict == "parameters") for each in found.findings],
            "suspects": [_finding(each, of_robot=False) for each in found.suspects],
            "candidates": [
                {
                    **picked(one, "effects score values accepted"),
                    "score_above_best": one.score - found.tried[0].score,
                    "rms_beyond_noise": one.fit,
                }
                for one in found.tried
            ],
            **picked(found, "remainder indistinguishable"),
            "next_experiment": plan
            and {
                "gait": picked(plan, "amplitude period offset"),
                **picked(plan, "start heading seconds between separation sentence"),
            },
            "fit": _fit(found),
            "loss": None,
            "residue": [
                {**_curve(one), **picked(one, "kind share sentence")} for one in found.residue
            ],
            "parameters": {name: _estimate(each) for name, each in found.parameters.items()},
            "values": found.values,
            "left_out": (),
            "doubts": self.doubts,
            "seconds": found.seconds,
        }


def _fit(found: Diagnosis) -> dict[str, Any]:
    """Misfits in units of the noise sigma.

    Without held-out recordings, `heldout` refers to the fitted ones.
    """
    levels = {"before": found.nominal, "parameters": found.refitted, "after": found.final}
    fitted = {name: [m for m in level if not m.held_out] for name, level in levels.items()}
    held = {name: [m for m in level if m.held_out] for name, level in levels.items()}
    return {
        "heldout_rms_before": found.before,
        "heldout_rms_parameters": _rms(held["parameters"] or fitted["parameters"]),
        "heldout_rms_after": found.after,
        "heldout_recordings": [m.recording for m in held["after"]],
        **{f"fitted_rms_{name}": _rms(level) for name, level in fitted.items()},
        "recordings": [
            _recording(dict(zip(levels, each, strict=True)))
            for each in zip(*levels.values(), strict=True)
        ],
    }


def _recording(levels: Mapping[str, Misfit]) -> dict[str, Any]:
    after = levels["after"]
    return {
        "file": after.recording,
        "use": "holdout" if after.held_out else "fit",
        **{name: one.rms for name, one in levels.items()},
        "channels": {
            channel: {name: one.channels.get(channel) for name, one in levels.items()}
            for channel in after.channels
        },
    }


def _rms(misfits: Iterable[Misfit]) -> float:
    """Root mean square over all their values, in sigma; NaN of none."""
    squares = [one.residuals.ravel() ** 2 for one in misfits]
    return float(np.sqrt(np.nanmean(np.concatenate(squares)))) if squares else float("nan")


def _curve(curve: Curve | Residue) -> dict[str, Any]:
    return picked(curve, "variable unit at mean error")


def _finding(finding: Finding, of_robot: bool) -> dict[str, Any]:
    """An effect; a parameter of the robot also has its value next to its name."""
    parameters = {name: _estimate(each) for name, each in finding.parameters.items()}
    return {
        **picked(finding, "name confidence removes lookalikes"),
        **(parameters.get(finding.name, {}) if of_robot else {}),
        "parameters": parameters,
    }


def _estimate(one: Estimate) -> dict[str, Any]:
    return {"value": one.value, "ci95": [one.low, one.high], "unit": one.unit}
