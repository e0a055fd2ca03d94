"""The report of a machine's diagnosis: page, record, corrected machine."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

from rr_opt.documents import document as doc
from rr_opt.documents.report import Report
from rr_opt.files.record import yaml_text
from rr_opt.formatting import with_unit
from rr_opt.model.machine import MachineRun
from rr_opt.report.captions import captions
from rr_opt.report.diagnosis import words
from rr_opt.report.diagnosis.record import _candidates, _estimate, _evidence, _finding, _recording
from rr_opt.results.machine_diagnosis import ExplainedMachine
from rr_opt.sysid.diagnosis import Finding

CORRECTED = "machine-corrected.yaml"


def headline(one: ExplainedMachine) -> str:
    """The verdict in a sentence."""
    machine, found = one.experiment.machine, one.found
    if found.verdict == "missing_physics":
        names = [machine.effect(each.name).words for each in found.findings]
        return f"The model leaves out {words.listed(names)}"
    if found.verdict == "parameters":
        names = [p.words for each in found.findings if (p := machine.parameter(each.name))]
        return f"The model is right, but the {words.listed(names)} not as believed"
    return words.headline(found)


def record(one: ExplainedMachine) -> dict[str, Any]:
    """The whole of `diagnosis.json`."""
    found = one.found
    levels = {"before": found.nominal, "parameters": found.refitted, "after": found.final}
    return {
        "name": one.name,
        "machine": one.experiment.machine.name,
        "verdict": found.verdict,
        "summary": found.summary,
        "mismatch": {"rms_beyond_noise": found.mismatch.rms, "p_value": found.mismatch.p_value},
        "location": {"channel": found.channel, "where": found.where,
                     "evidence": [_evidence(stage) for stage in found.stages]},
        "effects": [_finding(each, found.verdict == "parameters") for each in found.findings],
        "candidates": _candidates(found.tried),
        "remainder": found.remainder,
        "indistinguishable": found.indistinguishable,
        "next_experiment": None,
        "fit": {
            "window": one.window,
            "heldout_rms_before": found.before,
            "heldout_rms_after": found.after,
            "heldout_error": one.errors(True),
            "fitted_error": one.errors(False),
            "recordings": [_recording(dict(zip(levels, each, strict=True)))
                           for each in zip(*levels.values(), strict=True)],
        },
        "residue": found.residue,
        "parameters": {name: _estimate(each) for name, each in found.parameters.items()},
        "values": found.values,
        "doubts": one.warnings,
        "seconds": found.seconds,
    }  # fmt: skip


def document(one: ExplainedMachine, figures: Sequence[doc.Figure] = ()) -> doc.Document:
    """The report."""
    found, machine = one.found, one.experiment.machine
    return doc.Document(
        name=one.name,
        kind="diagnosis",
        title=headline(one),
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
                {"Effects": lambda each: words.candidate_words(each.effects),
                 "Score": lambda each: f"{each.score:.0f}",
                 "Misfit": lambda each: f"{words.total(each.fit):.2f} σ",
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
        yield f"These recordings cannot distinguish {words.candidate_words(group)}."
    left = one.found.remainder
    yield f"Remainder: {words.remainder_text(left)}. {left.matters}"


def _noise(one: ExplainedMachine, run: MachineRun) -> str:
    return ", ".join(f"{c.name} {with_unit(run.sigma[c.name], c.unit, 2)}"
                     for c in one.experiment.machine.channels if run.sigma[c.name] > 0)  # fmt: skip


def _effects(one: ExplainedMachine) -> doc.Table:
    def row(each: Finding, name: str) -> list[doc.Cell]:
        value = words.value_text(each.parameters[name])
        return [each.name.replace("_", " "), name, value, f"{each.confidence:.2f}"]

    rows = [row(each, name) for each in one.found.findings for name in each.parameters]
    return doc.table(["Effect", "Parameter", "Value [95 % interval]", "Confidence"], rows)


def _errors(one: ExplainedMachine) -> doc.Table:
    rows: list[list[doc.Cell]] = []
    for held in (False, True):
        for channel in one.experiment.machine.outputs:
            errors = one.errors(held)[channel.name]
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
                     words.value_text(each) if each else "exact"])  # fmt: skip
    return doc.table(["Parameter", "What", "As believed", "Estimated [95 %]"], rows)


def corrected(one: ExplainedMachine) -> dict[str, str]:
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
    return {CORRECTED: yaml_text(content, f"{headline(one)}.")}


REPORT = Report(
    record,
    document,
    "diagnosis.json",
    tables=corrected,
    others=(CORRECTED,),
    figures="rr_opt.report.figures.machine_diagnosis",
    captions=captions("machine"),
)
