"""A diagnosis as a document, as text for a terminal, and as a folder."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from pathlib import Path

import numpy as np

from rr_opt.answers.diagnosis import DiagnosisAnswer, Loss, LossUnknown
from rr_opt.files.record import robot_yaml
from rr_opt.formatting import number, with_unit
from rr_opt.model.experiment import Run
from rr_opt.model.parameters import Uncertainty, parameters_of
from rr_opt.report.archive import remove, write_json, write_text
from rr_opt.report.diagnosis.loss import loss_line, share_lost
from rr_opt.report.diagnosis.record import record
from rr_opt.report.diagnosis.words import (
    candidate_words,
    headline,
    interval_text,
    number_text,
    parameter_words,
    remainder_text,
    share_text,
    size_text,
    stage_words,
    value_text,
)
from rr_opt.report.document import (
    Badge,
    Cell,
    Chain,
    Document,
    Fact,
    Facts,
    Figure,
    Gallery,
    Section,
    Step,
    Table,
    table,
    warnings,
)
from rr_opt.report.text import terminal
from rr_opt.report.webpage import PAGE, write_page
from rr_opt.sysid.diagnosis import Estimate, Finding, Misfit
from rr_opt.version import __version__

_PLACES = (
    ("measurement", ("measurement",)),
    ("actuation", ("actuation",)),
    ("axles", ("constraint_axle1", "constraint_axle2")),
    ("rolling, yaw, mass", ("rolling", "yaw", "mass")),
    ("floor", ("floor",)),
)
"""Where an effect can act, upstream first."""


_FIGURES = {
    "evidence": ("What the fault depends on", "The misfit over what it depends on"),
    "residue": ("The force that has no name", "The estimated force over what it depends on"),
    "paths": ("Before and after: paths", "Recorded and simulated paths, seen from above"),
    "misfit": (
        "Before and after: misfit of each recording",
        "Misfit of each recording as believed, refitted and as found",
    ),
    "bands": (
        "Before and after: what the simulation leaves",
        "Bands of the residuals of each channel over time",
    ),
    "loss": (
        "What the wrong model would cost",
        "Speeds of the best gaits as believed and as found",
    ),
}


def diagnosis_document(one: DiagnosisAnswer, figures: Iterable[Figure] = ()) -> Document:
    """The report of a diagnosis."""
    found, loss = one.found, one.loss
    steps = ", ".join(f"{step} {time:.1f} s" for step, time in found.seconds.items())
    return Document(
        name=one.name,
        kind="diagnosis",
        title=headline(found),
        lead=found.summary,
        good=found.verdict == "consistent",
        sections=(
            Section("Where it goes wrong", (chain(one), chain_note(one))),
            Section("", (Facts(tuple(_key_facts(one)), key=True),)),
            Section("", (Gallery(tuple(figures)),)),
            Section("What was found", (effects_table(one),)),
            Section(
                "What the wrong model would cost",
                (loss.sentence if isinstance(loss, LossUnknown) else "",),
            ),
            Section("What remains open, and what to record next", tuple(_open(one))),
            Section("What was tried", (candidates_table(one),)),
            Section("The robot's parameters", (parameters_table(one),)),
            Section("Misfit by channel, before → after, σ", (misfit_table(one),)),
            Section("Recordings", (recordings_table(one), warnings((*one.left_out, *one.doubts)))),
        ),
        footer=(
            f"rr-opt {__version__}",
            f"input SHA-256 `{one.sha256}`",
            steps,
            "the corrected robot is in `robot-corrected.yaml`, all numbers in `diagnosis.json`",
        ),
    )


_STATES = {
    "fault": ("fault", "✗ fault"),
    "clear": ("clear", "✓ clear"),
    "affected": ("after", "affected"),
}


def chain(one: DiagnosisAnswer) -> Chain:
    """The stages; without tests of them, where the accepted effect acts."""
    stages, channel = one.found.stages, one.found.channel
    if stages:
        words = zip(stages, stage_words(stages), strict=True)
        return Chain(
            tuple(
                Step(stage.name.replace("_", " "), *_STATES[word], size_text(stage))
                for stage, word in words
            )
        )
    return Chain(
        tuple(
            Step(name, "fault", "✗ the effect acts here")
            if channel in channels
            else Step(name, "untested", "–")
            for name, channels in _PLACES
        )
    )


def chain_note(one: DiagnosisAnswer) -> str:
    """What is lit in the chain, and where the fault shows."""
    if not one.found.stages:
        lit = "" if one.found.channel == "none" else " Lit: where the accepted effect acts."
        return f"The stages were not tested one by one.{lit}"
    where = f"{one.where[0].upper()}{one.where[1:].removesuffix('.')}. " if one.where else ""
    if not one.guilty:
        return f"{where or 'No channel has a fault that counts. '}{_SIGMA}"
    return (
        f"{where}Lit: where an unknown input would explain most of the misfit of the nominal "
        f"model; the others follow the motion and are affected too. {_SIGMA}"
    )


_SIGMA = "σ: one standard deviation of the noise."


_MOST = 30
"""Rows of candidates; diagnosis.json has all."""


def effects_table(one: DiagnosisAnswer) -> Table:
    """What was accepted, with its values; nothing for a verdict without effects."""
    rows: list[list[Cell]] = []
    for finding in one.found.findings if one.found.verdict != "parameters" else ():
        for k, (name, value) in enumerate(finding.parameters.items()):
            first: list[Cell] = _effect_cells(finding) if k == 0 else ["", "", ""]
            rows.append([first[0], name, value_text(value), *first[1:]])
    head = ["Effect", "Parameter", "Value [95 % interval]", "Confidence", "Explains"]
    return table(head, rows)


def _effect_cells(finding: Finding) -> list[Cell]:
    removes = share_text(finding) + (", minor" if finding.minor else "")
    return [finding.name.replace("_", " "), f"{finding.confidence:.2f}", removes]


def candidates_table(one: DiagnosisAnswer) -> Table:
    """All sets of effects that were fitted, the best first."""
    tried = sorted(one.found.tried, key=lambda each: each.score)
    rows: list[list[Cell]] = [
        [
            candidate_words(each.effects),
            f"+{each.score - tried[0].score:.0f}",
            f"{each.fit:.2f} σ",
            Badge("accepted", "good") if each.accepted else "",
        ]
        for each in tried[:_MOST]
    ]
    head = ["Effects", "Score over the best", "Misfit", "Verdict"]
    return table(head, rows, _CANDIDATES if rows else "")


def parameters_table(one: DiagnosisAnswer) -> Table:
    """The robot's own parameters: as believed, and as estimated."""
    nominal = parameters_of(one.experiment.robot)
    moved = {
        name
        for finding in one.found.findings
        if one.found.verdict == "parameters"
        for name in finding.parameters
    }
    head = ["Parameter", "What", "As believed", "Estimated", "95 % interval"]
    head += ["Verdict"] if moved else []
    rows: list[list[Cell]] = []
    for name, value in one.found.parameters.items():
        if "." in name:
            continue
        believed = nominal.get(name)
        verdict: list[Cell] = [Badge("not as believed", "warn") if name in moved else ""]
        rows.append(
            [
                name,
                parameter_words(name),
                "–" if believed is None else _believed(value, believed, _known(one, name)),
                number_text(value, value.value),
                interval_text(value),
                *(verdict if moved else []),
            ]
        )
    return table(head, rows)


def _believed(value: Estimate, believed: float, known: Uncertainty | None) -> str:
    text = number_text(value, believed)
    if known is None:
        return text
    if known.factor is not None:
        return f"{text}, within a factor of {known.factor:g}"
    return f"{text} ± {number_text(value, known.sigma)}"


def _known(one: DiagnosisAnswer, name: str) -> Uncertainty | None:
    return one.experiment.uncertainty.get(name)


def misfit_table(one: DiagnosisAnswer) -> Table:
    """Misfit of every recording and channel, before and after."""
    rows: list[list[Cell]] = []
    for before, after in zip(one.found.nominal, one.found.final, strict=True):
        use = Badge("held out", "note") if after.held_out else "fitted"
        rows.append(
            [
                after.recording,
                use,
                f"{before.rms:.2f} → {after.rms:.2f}",
                *(_channel(before, after, name) for name in _channels(one)),
            ]
        )
    return table(["Recording", "Use", "All, σ", *_channels(one)], rows, _off(one))


def _channels(one: DiagnosisAnswer) -> list[str]:
    return list(dict.fromkeys(name for each in one.found.final for name in each.channels))


def _channel(before: Misfit, after: Misfit, name: str) -> str:
    if name not in before.channels or name not in after.channels:
        return "–"
    return f"{before.channels[name]:.2f} → {after.channels[name]:.2f}"


def recordings_table(one: DiagnosisAnswer) -> Table:
    """What was recorded."""
    rows: list[list[Cell]] = [_recorded(run) for run in one.experiment.runs]
    head = ["Recording", "Use", "Start", "Amplitude", "Period", "Offset", "Length", "Data"]
    return table(head, rows)


def _recorded(run: Run) -> list[Cell]:
    recording, gait = run.recording, run.gait
    flags = np.array([recording.flags[name] > 0 for name in recording.channels])
    share = 100 * (1 - float(flags.mean()))
    return [
        run.name,
        run.use,
        run.start,
        with_unit(gait.amplitude, "rad", 3),
        with_unit(gait.period, "s", 3),
        with_unit(gait.offset, "rad", 3),
        f"{recording.t[-1] - recording.t[0]:.3g} s",
        f"{len(recording)} samples, {number(share, 3)} % good",
    ]


_CANDIDATES = (
    "Each row was fitted to the fitted recordings, with the robot's parameters re-estimated. "
    "Score: twice the log predictive density lost, each recording predicted from the others; less "
    "is better. Misfit: what simulation leaves beyond the noise."
)


def _off(one: DiagnosisAnswer) -> str:
    off = one.found.mismatch
    return (
        "With the robot's values re-fitted within what was stated of them, the fitted recordings "
        f"are {off.rms:.2f} σ off beyond the noise; noise alone leaves that much or more with "
        f"probability {off.p_value:.2g}."
    )


def _key_facts(one: DiagnosisAnswer) -> Iterator[Fact]:
    found = one.found
    yield Fact("misfit before", f"{found.before:.2f} σ", one.proven_on)
    yield Fact("misfit now", f"{found.after:.2f} σ", "in units of the noise")
    for finding in found.findings[:3]:
        if found.verdict == "missing_physics":
            name = candidate_words([finding.name])
            yield Fact("of the mismatch explained by", share_text(finding), name)
        for name, each in list(finding.parameters.items())[:2]:
            value, _, interval = value_text(each).partition(" [")
            yield Fact(name, value, f"95 %: {interval.rstrip(']')}")
    if isinstance(one.loss, Loss):
        yield Fact(
            "of the speed lost", share_lost(one.loss), "by the best gait of the nominal model"
        )


def _open(one: DiagnosisAnswer) -> Iterator[str]:
    found = one.found
    for group in found.indistinguishable:
        names = " from ".join(candidate_words([name]) for name in group)
        yield f"These recordings cannot distinguish {names}."
    if found.verdict != "consistent":
        yield f"Remainder: {remainder_text(found.remainder)}. {found.remainder.matters}"
    yield from (each.sentence for each in found.residue)
    if found.next_experiment is not None:
        yield found.next_experiment.sentence


def summary(one: DiagnosisAnswer, written: Sequence[Path]) -> str:
    """The verdict, what was found with its intervals, before and after, and what to do next."""
    found = one.found
    rows: list[tuple[str, str]] = [("verdict", f"{found.verdict}: {headline(found)}")]
    if found.channel != "none":
        rows.append(("  shows in", found.channel.replace("_", " ")))
    if one.where:
        rows.append(("  where", one.where))
    rows += [row for finding in found.findings for row in _finding(finding, found.verdict)]
    rows += _misfit(one)
    rows += [
        (f"channel {stage.name.replace('_', ' ')}", f"{word}, {size_text(stage)}")
        for stage, word in zip(found.stages, stage_words(found.stages), strict=True)
    ]
    rows += [
        ("indistinguishable", " or ".join(name.replace("_", " ") for name in group))
        for group in found.indistinguishable
    ]
    if found.verdict != "consistent":
        rows.append(("remainder", remainder_text(found.remainder)))
    rows += [("left over", each.sentence) for each in found.residue]
    if one.loss is not None:
        rows.append(("lost speed", loss_line(one.loss)))
    if found.next_experiment is not None:
        rows.append(("record next", found.next_experiment.sentence))
    rows.append(("took", f"{sum(found.seconds.values()):.0f} s"))
    facts = Facts(tuple(Fact(label, text) for label, text in rows))
    sections = (Section("", (facts,)), Section("", (found.summary,)))
    return terminal(Document("", "diagnosis", "", "", sections), written)


def _finding(finding: Finding, verdict: str) -> list[tuple[str, str]]:
    if verdict == "parameters":
        return [(f"  {name}", value_text(value)) for name, value in finding.parameters.items()]
    minor = ", minor" if finding.minor else ""
    name = candidate_words([finding.name])
    head = f"confidence {finding.confidence:.2f}, explains {share_text(finding)}{minor}"
    values = [(f"  {key}", value_text(value)) for key, value in finding.parameters.items()]
    return [(name, head), *values]


def _misfit(one: DiagnosisAnswer) -> list[tuple[str, str]]:
    found = one.found
    before, after = f"{found.before:.2f} before", f"{found.after:.2f} after"
    return [("misfit", f"{before}, {after}, in units of the noise ({_proof(one)})")]


def _proof(one: DiagnosisAnswer) -> str:
    if not one.marked:
        return one.proven_on
    return f"{len(one.proof)} held out recording{'s' if len(one.proof) != 1 else ''}"


RECORD, ROBOT = "diagnosis.json", "robot-corrected.yaml"


def write_diagnosis(
    one: DiagnosisAnswer, folder: Path, *, page: bool, progress: Callable[[str], object]
) -> list[Path]:
    """Write everything; returns the files in the order to name them.

    What an earlier run left under the same names is removed before.
    """
    remove(folder, (RECORD, ROBOT, PAGE, *(f"{name}.svg" for name in _FIGURES)))
    progress("the best gait, as believed and as found")
    title = f"{headline(one.found)}.\nFrom {one.name} by rr-opt {__version__} diagnose."
    written = [
        write_json(folder / RECORD, record(one)),
        write_text(folder / ROBOT, robot_yaml(one.corrected_robot, title)),
    ]
    if not page:
        return written
    progress("figures")
    return write_page(folder, diagnosis_document(one, figures_of(one)), written)


def figures_of(one: DiagnosisAnswer) -> list[Figure]:
    """The figures, in order."""
    # Here and not above: without figures matplotlib need not be loaded.
    from rr_opt.report.figures.diagnosis import draw

    drawn, captions = draw(one)
    return [
        Figure(name, title, drawn[name], alt, captions[name])
        for name, (title, alt) in _FIGURES.items()
        if name in drawn
    ]
