"""The diagnosis of a machine other than the Roller Racer."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from rr_opt.documents import document as doc
from rr_opt.documents.rendering import terminal
from rr_opt.files.record import rounded, yaml_text
from rr_opt.formatting import with_unit
from rr_opt.model.machine import MachineExperiment, MachineRun
from rr_opt.results import diagnosis_tables as tables
from rr_opt.results.explained import Explained
from rr_opt.sysid.diagnosis import Misfit

CORRECTED = "machine-corrected.yaml"


@dataclass(frozen=True, repr=False)
class ExplainedMachine(Explained[MachineExperiment]):
    """The diagnosis; `found` is all of it, `window` the seconds over which it predicts."""

    OTHERS = (CORRECTED,)
    DRAW = "rr_opt.results.figures.diagnosis.draw_machine"
    CAPTIONS = doc.captions("machine")

    window: float

    def errors(self, *, held_out: bool) -> dict[str, dict[str, float]]:
        """RMS error of each output, SI: nominal, with parameters fitted, corrected."""
        found = self.found
        levels = {"before": found.nominal, "parameters": found.refitted, "after": found.final}
        return {
            one.name: {
                level: _error([m for m in misfits if m.held_out == held_out], k)
                for level, misfits in levels.items()
            }
            for k, one in enumerate(self.experiment.machine.outputs)
        }

    @property
    def headline(self) -> str:
        """The verdict in a sentence."""
        machine = self.experiment.machine
        return tables.headline(
            self.found,
            lambda name: machine.effect(name).words,
            lambda name: one.words if (one := machine.parameter(name)) else name,
        )

    def _record(self) -> dict[str, Any]:
        record = super()._record()
        errors = {
            "window": self.window,
            "heldout_error": self.errors(held_out=True),
            "fitted_error": self.errors(held_out=False),
        }
        return record | {
            "machine": self.experiment.machine.name,
            "fit": {**record["fit"], **errors},
        }

    def document(self, figures: Sequence[doc.Figure] = ()) -> doc.Document:
        """The report."""
        found, machine = self.found, self.experiment.machine
        faults = (f"{one.name}: {one.where or 'nothing significant'}" for one in found.stages)
        recordings = doc.table_of(
            self.experiment.runs,
            {
                "Recording": lambda run: run.name,
                "Use": lambda run: "held out" if run.held_out else "fitted",
                "Length": lambda run: f"{run.t[-1]:.3g} s",
                "Samples": len,
                "Noise": self._noise,
            },
        )
        sections: dict[str, tuple[doc.Block, ...]] = {
            "Prediction errors": (self._errors(),),
            "Where it goes wrong": tuple(faults),
            "What remains open": tuple(self._open()),
            "What was tried": (tables.candidates_table(found),),
            f"Parameters of {machine.words}: {machine.equation}": (self._parameters(),),
            "Recordings": (recordings, doc.warnings(self.warnings)),
        }
        return doc.Document(
            name=self.name,
            kind="diagnosis",
            title=self.headline,
            lead=found.summary,
            good=found.verdict == "consistent",
            sections=(
                doc.section("What was found", tables.effects_table(found)),
                doc.gallery(figures),
                *(doc.Section(title, blocks) for title, blocks in sections.items()),
            ),
            footer=(*doc.versions(self.sha256), "all numbers are in `diagnosis.json`"),
            machine=machine.name.capitalize(),
        )

    def summary(self) -> str:
        """The verdict in a paragraph, and the tables."""
        whole = self.document()
        lead = doc.section("", self.found.summary)
        return terminal(replace(whole, lead="", sections=(lead, *whole.sections)))

    def _open(self) -> Iterator[str]:
        for tie in self.found.ties:
            yield f"These recordings cannot distinguish {tables.tie_text(tie, self.found)}."
        left = self.found.remainder
        yield f"Remainder: {tables.remainder_text(left)}. {left.matters}"

    def _noise(self, run: MachineRun) -> str:
        channels = (one for one in self.experiment.machine.channels if run.sigma[one.name] > 0)
        return ", ".join(f"{c.name} {with_unit(run.sigma[c.name], c.unit, 2)}" for c in channels)

    def _errors(self) -> doc.Table:
        rows: list[list[doc.Cell]] = []
        for held in (False, True):
            for channel in self.experiment.machine.outputs:
                errors = self.errors(held_out=held)[channel.name]
                shown = [with_unit(x, channel.unit, 3) for x in errors.values()]
                rows.append(["held out" if held else "fitted", channel.words, *shown])
        note = f"RMS over windows of {self.window:g} s; only their initial states are fitted."
        head = ["Recordings", "Output", "Nominal", "Values fitted", "Corrected"]
        return doc.table(head, rows, note)

    def _parameters(self) -> doc.Table:
        nominal, estimates = self.experiment.nominal, self.found.parameters
        return doc.table_of(
            self.experiment.machine.parameters,
            {
                "Parameter": lambda p: p.name,
                "What": lambda p: p.words,
                "Nominal": lambda p: with_unit(nominal[p.name], p.unit, 4),
                "Estimated [95 %]": lambda p: (
                    tables.value_text(estimates[p.name]) if p.name in estimates else "exact"
                ),
            },
        )

    def _tables(self) -> dict[str, str]:
        """The machine's corrected values, as keys of an experiment file, and its effects."""
        machine, values = self.experiment.machine, self.found.values
        nominal = self.experiment.nominal
        own = {p.name: rounded(values.get(p.name, nominal[p.name])) for p in machine.parameters}
        effects: dict[str, dict[str, float]] = {}
        for name, value in values.items():
            effect, dot, constant = name.partition(".")
            if dot:
                effects.setdefault(effect, {})[constant] = rounded(value)
        content = {"machine": machine.name, "parameters": own, "physics": effects}
        return {
            CORRECTED: yaml_text(content, f"{self.headline}. {tables.caveat(self.found)}".strip())
        }


def _error(misfits: list[Misfit], k: int) -> float:
    off = [(m.predicted - m.recorded)[:, k] for m in misfits]
    return float(np.sqrt(np.nanmean(np.concatenate(off) ** 2))) if off else float("nan")
