"""The diagnosis of a machine other than the Roller Racer."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from rr_opt.documents import document as doc
from rr_opt.documents.texts import captions
from rr_opt.files.record import yaml_text
from rr_opt.formatting import with_unit
from rr_opt.model.machine import MachineExperiment, MachineRun
from rr_opt.results.diagnosis_record import diagnosis_record
from rr_opt.results.diagnosis_tables import (
    candidate_words,
    headline,
    listed,
    remainder_text,
    total,
    value_text,
)
from rr_opt.results.result import Result
from rr_opt.sysid.diagnosis import Diagnosis, Finding, Misfit

CORRECTED = "machine-corrected.yaml"


@dataclass(frozen=True, repr=False)
class ExplainedMachine(Result):
    """The diagnosis; `found` is all of it, `window` the seconds over which it predicts."""

    FILE = "diagnosis.json"
    OTHERS = (CORRECTED,)
    DRAW = "rr_opt.results.figures.machine_diagnosis.draw"
    CAPTIONS = captions("machine")

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

    def errors(self, *, held_out: bool) -> dict[str, dict[str, float]]:
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

    def _record(self) -> dict[str, Any]:
        return _record(self)

    def document(self, figures: Sequence[doc.Figure] = ()) -> doc.Document:
        """The report."""
        return _document(self, figures)

    def _tables(self) -> dict[str, str]:
        return _corrected(self)


def _error(misfits: list[Misfit], k: int) -> float:
    off = [(m.predicted - m.recorded)[:, k] for m in misfits]
    return float(np.sqrt(np.nanmean(np.concatenate(off) ** 2))) if off else float("nan")


def _headline(one: ExplainedMachine) -> str:
    """The verdict in a sentence."""
    machine, found = one.experiment.machine, one.found
    if found.verdict == "missing_physics":
        names = [machine.effect(each.name).words for each in found.findings]
        return f"The model leaves out {listed(names)}"
    if found.verdict == "parameters":
        names = [p.words for each in found.findings if (p := machine.parameter(each.name))]
        return f"The model is right, but the {listed(names)} not as believed"
    return headline(found)


def _record(one: ExplainedMachine) -> dict[str, Any]:
    """The whole of `diagnosis.json`."""
    found = diagnosis_record(one.found, one.found.where)
    errors = {
        "window": one.window,
        "heldout_error": one.errors(held_out=True),
        "fitted_error": one.errors(held_out=False),
    }
    return {
        "name": one.name,
        "machine": one.experiment.machine.name,
        **found,
        "fit": {**found["fit"], **errors},
        "doubts": one.warnings,
    }


def _document(one: ExplainedMachine, figures: Sequence[doc.Figure] = ()) -> doc.Document:
    """The report."""
    found, machine = one.found, one.experiment.machine
    return doc.Document(
        name=one.name,
        kind="diagnosis",
        title=_headline(one),
        lead=found.summary,
        good=found.verdict == "consistent",
        sections=(
            doc.Section("What was found", (_effects(one),)),
            doc.gallery(figures),
            doc.Section("Errors of prediction", (_errors(one),)),
            doc.Section("Where it goes wrong", tuple(
                f"{stage.name}: {stage.where or 'nothing significant'}" for stage in found.stages)),
            doc.Section("What remains open", tuple(_open(one))),
            doc.Section("What was tried", (doc.table_of(
                sorted(found.tried, key=lambda each: each.score)[:20],
                {"Effects": lambda each: candidate_words(each.effects),
                 "Score": lambda each: f"{each.score:.0f}",
                 "Misfit": lambda each: f"{total(each.fit):.2f} σ",
                 "": lambda each: "accepted" if each.accepted else ""}),)),
            doc.Section(f"Parameters of {machine.words}: {machine.equation}", (_parameters(one),)),
            doc.Section("Recordings", (doc.table_of(one.experiment.runs, {
                "Recording": lambda run: run.name,
                "Use": lambda run: "held out" if run.held_out else "fitted",
                "Length": lambda run: f"{run.t[-1]:.3g} s",
                "Samples": len,
                "Noise": lambda run: _noise(one, run)}), doc.warnings(one.warnings))),
        ),
        footer=(*doc.versions(one.sha256), "all numbers are in `diagnosis.json`"),
    )  # fmt: skip


def _open(one: ExplainedMachine) -> Iterator[str]:
    for group in one.found.indistinguishable:
        yield f"These recordings cannot distinguish {candidate_words(group)}."
    left = one.found.remainder
    yield f"Remainder: {remainder_text(left)}. {left.matters}"


def _noise(one: ExplainedMachine, run: MachineRun) -> str:
    return ", ".join(f"{c.name} {with_unit(run.sigma[c.name], c.unit, 2)}"
                     for c in one.experiment.machine.channels if run.sigma[c.name] > 0)  # fmt: skip


def _effects(one: ExplainedMachine) -> doc.Table:
    def row(each: Finding, name: str) -> list[doc.Cell]:
        value = value_text(each.parameters[name])
        return [each.name.replace("_", " "), name, value, f"{each.confidence:.2f}"]

    rows = [row(each, name) for each in one.found.findings for name in each.parameters]
    return doc.table(["Effect", "Parameter", "Value [95 % interval]", "Confidence"], rows)


def _errors(one: ExplainedMachine) -> doc.Table:
    rows: list[list[doc.Cell]] = []
    for held in (False, True):
        for channel in one.experiment.machine.outputs:
            errors = one.errors(held_out=held)[channel.name]
            shown = [with_unit(x, channel.unit, 3) for x in errors.values()]
            rows.append(["held out" if held else "fitted", channel.words, *shown])
    note = f"RMS over windows of {one.window:g} s, whose initial states alone are fitted."
    return doc.table(
        ["Recordings", "Output", "As believed", "Values fitted", "As found"], rows, note
    )


def _parameters(one: ExplainedMachine) -> doc.Table:
    rows: list[list[doc.Cell]] = []
    for p in one.experiment.machine.parameters:
        each = one.found.parameters.get(p.name)
        nominal = one.experiment.nominal[p.name]
        rows.append([p.name, p.words, with_unit(nominal, p.unit, 4),
                     value_text(each) if each else "exact"])  # fmt: skip
    return doc.table(["Parameter", "What", "As believed", "Estimated [95 %]"], rows)


def _corrected(one: ExplainedMachine) -> dict[str, str]:
    """The machine's values as found, as the keys of an experiment file, and its effects."""
    values = one.found.values
    own = {p.name: float(f"{values.get(p.name, one.experiment.nominal[p.name]):.7g}")
           for p in one.experiment.machine.parameters}  # fmt: skip
    effects: dict[str, dict[str, float]] = {}
    for name, value in values.items():
        effect, dot, constant = name.partition(".")
        if dot:
            effects.setdefault(effect, {})[constant] = float(f"{value:.7g}")
    content = {"machine": one.experiment.machine.name, "parameters": own, "physics": effects}
    return {CORRECTED: yaml_text(content, f"{_headline(one)}.")}
