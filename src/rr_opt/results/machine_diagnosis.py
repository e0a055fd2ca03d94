"""The diagnosis of a machine other than the Roller Racer."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from rr_opt.model.machine import MachineExperiment
from rr_opt.results.result import Result
from rr_opt.sysid.diagnosis import Diagnosis, Finding, Misfit


@dataclass(frozen=True, repr=False)
class ExplainedMachine(Result):
    """The diagnosis; `found` is all of it, `window` the seconds over which it predicts."""

    REPORT = "rr_opt.report.machine_diagnosis"

    name: str
    sha256: str
    experiment: MachineExperiment
    found: Diagnosis
    window: float

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
    def warnings(self) -> tuple[str, ...]:
        """What looked wrong in the recordings."""
        return tuple(f"{run.name}: {one}" for run in self.experiment.runs for one in run.doubts)

    def errors(self, held_out: bool) -> dict[str, dict[str, float]]:
        """RMS error of each output, SI: as believed, with parameters fitted, as found."""
        found = self.found
        levels = {"before": found.nominal, "parameters": found.refitted, "after": found.final}
        return {
            one.name: {
                level: _error([m for m in misfits if m.held_out == held_out], k)
                for level, misfits in levels.items()
            }
            for k, one in enumerate(self.experiment.machine.outputs)
        }


def _error(misfits: list[Misfit], k: int) -> float:
    off = [(m.predicted - m.recorded)[:, k] for m in misfits]
    return float(np.sqrt(np.nanmean(np.concatenate(off) ** 2))) if off else float("nan")
