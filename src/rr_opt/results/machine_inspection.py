"""Recordings of a machine other than the Roller Racer, as they were found."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import PurePath
from typing import Any

import numpy as np

from rr_opt.documents import document as doc
from rr_opt.documents.texts import captions
from rr_opt.formatting import counted, with_unit
from rr_opt.model.machine import MachineExperiment, MachineRun
from rr_opt.results.result import Progress, Result


@dataclass(frozen=True, repr=False)
class InspectedMachine(Result):
    """The recordings of an experiment, read and cleaned; all are in `experiment.runs`."""

    FILE = "inspection.json"
    DRAW = "rr_opt.results.figures.inspection.draw_machine"
    CAPTIONS = captions("machine inspection")
    SVGS = False

    experiment: MachineExperiment

    @property
    def sha256(self) -> str:
        """Of the experiment's file and its recordings."""
        return self.experiment.sha256

    @property
    def warnings(self) -> tuple[str, ...]:
        """What looks wrong, each with its recording's name."""
        return tuple(f"{run.name}: {doubt}" for run in self.experiment.runs for doubt in run.doubts)

    def drawn(self, progress: Progress = lambda _: None) -> tuple[doc.Figure, ...]:
        """The channels of each recording."""
        figures = []
        for run in self.experiment.runs:
            progress(f"figure of {run.name}")
            for one in doc.captioned(self.CAPTIONS, self._draw((self.experiment.machine, run))):
                title = f"{run.name}: {one.title}"
                figures.append(
                    replace(one, name=f"{PurePath(run.name).stem}-{one.name}", title=title)
                )
        return tuple(figures)

    def _record(self) -> dict[str, Any]:
        return {
            "name": self.experiment.name,
            "machine": self.experiment.machine.name,
            "recordings": [self._recording(run) for run in self.experiment.runs],
        }

    def _recording(self, run: MachineRun) -> dict[str, Any]:
        return {
            "file": run.name,
            "use": "holdout" if run.held_out else "fit",
            "samples": len(run),
            "rate": _rate(run),
            "seconds": run.t[-1] - run.t[0],
            "channels": {
                name: {
                    "low": np.nanmin(y),
                    "high": np.nanmax(y),
                    "missing": int(np.isnan(y).sum()),
                    "sigma": run.sigma[name],
                }
                for name, y in _data(run).items()
            },
            "doubts": run.doubts,
        }

    def document(self, figures: Sequence[doc.Figure] = ()) -> doc.Document:
        """Every recording with its channels and warnings."""
        experiment, count = self.experiment, len(self.warnings)
        sections = [doc.Section(run.name, tuple(self._blocks(run))) for run in experiment.runs]
        return doc.Document(
            name=experiment.name,
            kind="recordings",
            title=f"{counted(len(experiment.runs), 'recording')} of {experiment.machine.words} "
            + (f"with {counted(count, 'warning')}" if count else "without warnings"),
            lead="Read each warning before using the recording. Wild samples were left out."
            if count
            else "Nothing looks wrong in the recordings.",
            good=not count,
            sections=(*sections, doc.gallery(figures)),
            footer=doc.versions(self.sha256),
        )

    def _blocks(self, run: MachineRun) -> list[doc.Block]:
        length = f"{with_unit(float(run.t[-1]), 's')}, {len(run)} samples at "
        facts = doc.Facts((doc.Fact("length", length + with_unit(_rate(run), "Hz")),))
        data = _data(run)
        channels = doc.table_of(
            [one for one in self.experiment.machine.channels if one.name in data],
            {
                "Channel": lambda c: f"{c.words} ({c.name})",
                "From": lambda c: with_unit(float(np.nanmin(data[c.name])), c.unit, 3),
                "To": lambda c: with_unit(float(np.nanmax(data[c.name])), c.unit, 3),
                "Noise": lambda c: (
                    with_unit(run.sigma[c.name], c.unit, 2) if run.sigma[c.name] else "exact"
                ),
                "Missing": lambda c: str(int(np.isnan(data[c.name]).sum())),
            },
        )
        return [facts, channels, doc.warnings(run.doubts) if run.doubts else "No warnings."]


def _data(run: MachineRun) -> Mapping[str, np.ndarray]:
    return {**run.inputs, **run.outputs}


def _rate(run: MachineRun) -> float:
    return 1 / float(np.median(np.diff(run.t)))
