"""The report of a diagnosis."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path

from rr_opt.documents.document import (
    Chain,
    Document,
    Fact,
    Facts,
    Figure,
    Gallery,
    Section,
    Step,
    versions,
    warnings,
)
from rr_opt.documents.report import Progress, Report, quiet
from rr_opt.files.record import robot_yaml
from rr_opt.report.diagnosis.loss import share_lost
from rr_opt.report.diagnosis.record import record
from rr_opt.report.diagnosis.summary import summary
from rr_opt.report.diagnosis.tables import (
    candidates_table,
    effects_table,
    misfit_table,
    parameters_table,
    recordings_table,
)
from rr_opt.report.diagnosis.words import (
    candidate_words,
    headline,
    remainder_text,
    share_text,
    size_text,
    stage_words,
    value_text,
)
from rr_opt.results.diagnosis import ExplainedExperiment
from rr_opt.results.loss import Loss, LossUnknown
from rr_opt.version import __version__

_PLACES = (
    ("measurement", ("measurement",)),
    ("actuation", ("actuation",)),
    ("axles", ("constraint_axle1", "constraint_axle2")),
    ("rolling, yaw, mass", ("rolling", "yaw", "mass")),
    ("floor", ("floor",)),
)
"""Where an effect can act, upstream first."""


def diagnosis_document(one: ExplainedExperiment, figures: Sequence[Figure] = ()) -> Document:
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
            *versions(one.sha256),
            steps,
            "the corrected robot is in `robot-corrected.yaml`, all numbers in `diagnosis.json`",
        ),
    )


_STATES = {
    "fault": ("fault", "✗ fault"),
    "clear": ("clear", "✓ clear"),
    "affected": ("after", "affected"),
}


def chain(one: ExplainedExperiment) -> Chain:
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


def chain_note(one: ExplainedExperiment) -> str:
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


def _key_facts(one: ExplainedExperiment) -> Iterator[Fact]:
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


def _open(one: ExplainedExperiment) -> Iterator[str]:
    found = one.found
    for group in found.indistinguishable:
        names = " from ".join(candidate_words([name]) for name in group)
        yield f"These recordings cannot distinguish {names}."
    if found.verdict != "consistent":
        yield f"Remainder: {remainder_text(found.remainder)}. {found.remainder.matters}"
    yield from (each.sentence for each in found.residue)
    if found.next_experiment is not None:
        yield found.next_experiment.sentence


CAPTIONS = {
    "evidence": ("What the fault depends on", "The misfit over what it depends on", ""),
    "residue": ("The force that has no name", "The estimated force over what it depends on", ""),
    "paths": ("Before and after: paths", "Recorded and simulated paths, seen from above", ""),
    "misfit": (
        "Before and after: misfit of each recording",
        "Misfit of each recording as believed, refitted and as found",
        "",
    ),
    "bands": (
        "Before and after: what the simulation leaves",
        "Bands of the residuals of each channel over time",
        "",
    ),
    "loss": (
        "What the wrong model would cost",
        "Speeds of the best gaits as believed and as found",
        "",
    ),
}
"""Captions themselves depend on what was found."""


ROBOT = "robot-corrected.yaml"


def robot_file(one: ExplainedExperiment) -> dict[str, str]:
    """The corrected robot as a robot file."""
    title = f"{headline(one.found)}.\nFrom {one.name} by rr-opt {__version__} diagnose."
    return {ROBOT: robot_yaml(one.corrected_robot, title)}


class _Report(Report):
    def text(self, result: ExplainedExperiment, files: Sequence[Path]) -> str:
        """The summary."""
        return summary(result, files)

    def drawn(self, result: ExplainedExperiment, progress: Progress = quiet) -> tuple[Figure, ...]:
        """The figures, each with the caption that was drawn for it."""
        progress("figures")
        from rr_opt.report.figures.diagnosis import draw

        drawn = draw(result)
        return tuple(
            Figure(name, title, drawn[name][0], alt, drawn[name][1])
            for name, (title, alt, _) in self.captions.items()
            if name in drawn
        )


REPORT = _Report(
    record,
    diagnosis_document,
    "diagnosis.json",
    tables=robot_file,
    others=(ROBOT,),
    captions=CAPTIONS,
)
