"""The report of a diagnosis."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path

from rr_opt.documents import document as doc
from rr_opt.documents.report import Progress, Report, quiet
from rr_opt.documents.texts import captions
from rr_opt.files.record import robot_yaml
from rr_opt.report.diagnosis import words
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


def diagnosis_document(
    one: ExplainedExperiment, figures: Sequence[doc.Figure] = ()
) -> doc.Document:
    """The report of a diagnosis."""
    found, loss = one.found, one.loss
    steps = ", ".join(f"{step} {time:.1f} s" for step, time in found.seconds.items())
    return doc.Document(
        name=one.name,
        kind="diagnosis",
        title=words.headline(found),
        lead=found.summary,
        good=found.verdict == "consistent",
        sections=(
            doc.Section("Where it goes wrong", (chain(one), chain_note(one))),
            doc.Section("", (doc.Facts(tuple(_key_facts(one)), key=True),)),
            doc.gallery(figures),
            doc.Section("What was found", (effects_table(one),)),
            doc.Section(
                "What the wrong model would cost",
                (loss.sentence if isinstance(loss, LossUnknown) else "",),
            ),
            doc.Section("What remains open, and what to record next", tuple(_open(one))),
            doc.Section("What was tried", (candidates_table(one),)),
            doc.Section("The robot's parameters", (parameters_table(one),)),
            doc.Section("Misfit by channel, before → after, σ", (misfit_table(one),)),
            doc.Section(
                "Recordings", (recordings_table(one), doc.warnings((*one.left_out, *one.doubts)))
            ),
        ),
        footer=(
            *doc.versions(one.sha256),
            steps,
            "the corrected robot is in `robot-corrected.yaml`, all numbers in `diagnosis.json`",
        ),
    )


_STATES = {
    "fault": ("fault", "✗ fault"),
    "clear": ("clear", "✓ clear"),
    "affected": ("after", "affected"),
}


def chain(one: ExplainedExperiment) -> doc.Chain:
    """The stages; without tests of them, where the accepted effect acts."""
    stages, channel = one.found.stages, one.found.channel
    if stages:
        marked = zip(stages, words.stage_words(stages), strict=True)
        return doc.Chain(
            tuple(
                doc.Step(
                    words.stage_name(stage), *_STATES[word], words.stage_text(stage, one.found)
                )
                for stage, word in marked
            )
        )
    return doc.Chain(
        tuple(
            doc.Step(name, "fault", "✗ the effect acts here")
            if channel in channels
            else doc.Step(name, "untested", "–")
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
        return f"{where or 'No channel has a significant fault. '}{_SIGMA}"
    return (
        f"{where}Lit: where an unknown input would explain most of the misfit of the nominal "
        f"model; the motion passes the fault on to the other channels. {_SIGMA}"
    )


_SIGMA = (
    "Percentages: the share of the misfit that an unknown input there would explain, with the "
    "robot's values re-fitted. All misfits on this page are RMS in σ, one standard deviation of "
    "the noise, so 1 is the noise alone."
)


def _key_facts(one: ExplainedExperiment) -> Iterator[doc.Fact]:
    found = one.found
    yield doc.Fact("misfit before", f"{found.before:.2f} σ", one.proven_on)
    yield doc.Fact("misfit now", f"{found.after:.2f} σ", "1 is the noise alone")
    for finding in found.findings[:3]:
        if found.verdict == "missing_physics":
            name = words.candidate_words([finding.name])
            beyond = "of the misfit beyond the noise"
            yield doc.Fact(f"explained by {name}", words.share_text(finding), beyond)
        for name, each in list(finding.parameters.items())[:2]:
            value, _, interval = words.value_text(each).partition(" [")
            yield doc.Fact(name.replace("_", " "), value, f"95 %: {interval.rstrip(']')}")
    if isinstance(one.loss, Loss):
        lost = share_lost(one.loss)
        yield doc.Fact("speed lost", lost, "by driving the best gait of the nominal model")


def _open(one: ExplainedExperiment) -> Iterator[str]:
    found = one.found
    for group in found.indistinguishable:
        names = " from ".join(words.candidate_words([name]) for name in group)
        yield f"These recordings cannot distinguish {names}."
    if found.verdict != "consistent":
        yield f"Remainder: {words.remainder_text(found.remainder)}. {found.remainder.matters}"
    yield from (each.sentence for each in found.residue)
    if found.next_experiment is not None:
        yield found.next_experiment.sentence


ROBOT = "robot-corrected.yaml"


def robot_file(one: ExplainedExperiment) -> dict[str, str]:
    """The corrected robot as a robot file."""
    title = f"{words.headline(one.found)}.\nFrom {one.name} by rr-opt {__version__} diagnose."
    return {ROBOT: robot_yaml(one.corrected_robot, title)}


class _Report(Report):
    def text(self, result: ExplainedExperiment, files: Sequence[Path]) -> str:
        """The summary."""
        return summary(result, files)

    def drawn(
        self, result: ExplainedExperiment, progress: Progress = quiet
    ) -> tuple[doc.Figure, ...]:
        """The figures, each with the caption that was drawn for it."""
        progress("figures")
        drawn = self.draw(result)
        return tuple(
            doc.Figure(name, title, drawn[name][0], alt, drawn[name][1])
            for name, (title, alt, _) in self.captions.items()
            if name in drawn
        )


REPORT = _Report(
    record,
    diagnosis_document,
    "diagnosis.json",
    tables=robot_file,
    others=(ROBOT,),
    figures="rr_opt.report.figures.diagnosis",
    captions=captions("diagnosis"),
)
