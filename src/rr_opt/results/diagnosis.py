"""The diagnosis of an experiment: what was found, the corrected robot, and the report."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

from rr_opt.documents import document as doc
from rr_opt.documents.rendering import terminal
from rr_opt.effects import CATALOGUE
from rr_opt.files.record import robot_yaml
from rr_opt.formatting import counted, words_of
from rr_opt.model.experiment import Experiment
from rr_opt.model.robot import Robot
from rr_opt.results import diagnosis_tables as tables
from rr_opt.results.explained import Explained
from rr_opt.results.loss import (
    Loss,
    LossUnknown,
    corrected_robot,
    loss_line,
    loss_of,
    loss_record,
    share_lost,
    unknown,
)
from rr_opt.results.result import Progress, quiet
from rr_opt.sysid.diagnosis import Finding, Stage
from rr_opt.version import __version__

_PREDICTS = 1.2
"""An empirical term accounts for the mismatch if the misfit left is at most this, in sigma."""


@dataclass(frozen=True, repr=False)
class ExplainedExperiment(Explained[Experiment]):
    """The diagnosis of an experiment.

    name, sha256     of the input
    verdict          `consistent`, `parameters`, `missing_physics` or `unexplained`
    effects          accepted, strongest first, each with `name`, `confidence` and `parameters`,
                     whose `value`, `low` and `high` (95 %) are in SI; for the verdict `parameters`
                     those
    corrected_robot  the nominal robot with all of them, for use with any other function
    loss             what the best gait of the nominal robot would lose, or why that is unknown
    found            the whole diagnosis
    left_out         sentences on unusable recordings
    """

    OTHERS = ("robot-corrected.yaml",)
    DRAW = "rr_opt.results.figures.diagnosis.draw"
    CAPTIONS = doc.captions("diagnosis")

    left_out: tuple[str, ...] = ()

    @cached_property
    def corrected_robot(self) -> Robot:
        """The nominal robot with the estimated values and the accepted effects."""
        return corrected_robot(self.experiment, self.found)

    @cached_property
    def loss(self) -> Loss | LossUnknown | None:
        """The speed lost with the nominal robot's best gait; None if the nominal model is right."""
        if self.verdict == "consistent":
            return None
        empirical = any(not CATALOGUE[use.name].candidate for use in self.corrected_robot.physics)
        if self.verdict == "unexplained" and not (empirical and self.found.after < _PREDICTS):
            return unknown("the corrected robot still lacks the unidentified physics.")
        return loss_of(self.experiment, self.corrected_robot)

    @property
    def warnings(self) -> tuple[str, ...]:
        """Sentences on unusable recordings, then on those that were used."""
        return (*self.left_out, *self.doubts)

    @property
    def guilty(self) -> tuple[Stage, ...]:
        """The stages that show a fault."""
        return tuple(stage for stage in self.found.stages if stage.guilty)

    @property
    def where(self) -> str:
        """Where the fault shows, in words; empty if unknown."""
        return self.found.where or "; ".join(one.where for one in self.guilty if one.where)

    @property
    def marked(self) -> bool:
        """Whether the experiment has a held-out recording."""
        return any(one.held_out for one in self.found.final)

    @property
    def proven_on(self) -> str:
        """The recordings that the misfits before and after refer to."""
        if self.marked:
            return "held-out recordings"
        several = len(self.found.final) > 1
        return (
            "the fitted recordings; none was held out" if several else "the only recording, fitted"
        )

    @property
    def proof(self) -> tuple[int, ...]:
        """Indices of the recordings that prove the fit: the held-out ones; all, if there are none.

        The worst explained by the nominal model come first.
        """
        nominal = self.found.nominal
        rows = [k for k, one in enumerate(nominal) if one.held_out] or range(len(nominal))
        return tuple(sorted(rows, key=lambda k: -nominal[k].rms))

    def save(
        self, path: str | Path, *, figures: bool = True, progress: Progress = quiet
    ) -> list[Path]:
        """Write diagnosis.json, robot-corrected.yaml, the figures and the page."""
        progress("the best gaits of the nominal and the corrected robot")
        return super().save(path, figures=figures, progress=progress)

    def document(self, figures: Sequence[doc.Figure] = ()) -> doc.Document:
        """The report of a diagnosis."""
        found, loss = self.found, self.loss
        steps = ", ".join(f"{step} {time:.1f} s" for step, time in found.seconds.items())
        cost = loss.sentence if isinstance(loss, LossUnknown) else ""
        recordings = tables.recordings_table(self.experiment), doc.warnings(self.warnings)
        sections: dict[str, tuple[doc.Block, ...]] = {
            "What was found": (tables.effects_table(found),),
            "What the wrong model would cost": (cost,),
            "What remains open, and what to record next": tuple(_open(self)),
            "What was tried": (tables.candidates_table(found),),
            "The robot's parameters": (tables.parameters_table(found, self.experiment),),
            "Misfit by channel, before → after, σ": (tables.misfit_table(found),),
            "Recordings": recordings,
        }
        return doc.Document(
            name=self.name,
            kind="diagnosis",
            title=tables.headline(found),
            lead=found.summary,
            good=found.verdict == "consistent",
            sections=(
                doc.section("Where it goes wrong", chain(self), chain_note(self)),
                doc.section("", doc.facts(_key_facts(self), key=True)),
                doc.gallery(figures),
                *(doc.Section(title, blocks) for title, blocks in sections.items()),
            ),
            footer=(
                *doc.versions(self.sha256),
                steps,
                "the corrected robot is in `robot-corrected.yaml`, all numbers in `diagnosis.json`",
            ),
        )

    def summary(self) -> str:
        """The verdict, findings with their intervals, misfits before and after, and next steps."""
        return terminal(doc.facts_alone(_summary_facts(self), self.found.summary))

    def _record(self) -> dict[str, Any]:
        return super()._record() | {"loss": loss_record(self.loss), "left_out": self.left_out}

    def _tables(self) -> dict[str, str]:
        title = f"{tables.headline(self.found)}.\n{tables.caveat(self.found)}"
        title = f"{title.strip()}\nFrom {self.name} by rr-opt {__version__} diagnose."
        return {self.OTHERS[0]: robot_yaml(self.corrected_robot, title)}


_PLACES = (
    ("measurement", ("measurement",)),
    ("actuation", ("actuation",)),
    ("axles", ("constraint_axle1", "constraint_axle2")),
    ("rolling, yaw, mass", ("rolling", "yaw", "mass")),
    ("floor", ("floor",)),
)
"""Where an effect can act, upstream first."""

_STATES = {
    "fault": ("fault", "✗ fault"),
    "clear": ("clear", "✓ clear"),
    "affected": ("after", "affected"),
}


def chain(one: ExplainedExperiment) -> doc.Chain:
    """The stages; without tests of them, where the accepted effect acts."""
    found = one.found
    if not found.stages:
        acts = "fault", "✗ the effect acts here"
        steps = (
            doc.Step(name, *(acts if found.channel in channels else ("untested", "–")))
            for name, channels in _PLACES
        )
    else:
        steps = (
            doc.Step(tables.stage_name(stage), *_STATES[word], tables.stage_text(stage, found))
            for stage, word in zip(found.stages, tables.stage_words(found.stages), strict=True)
        )
    return doc.Chain(tuple(steps))


def chain_note(one: ExplainedExperiment) -> str:
    """What the chain highlights, and where the fault shows."""
    if not one.found.stages:
        lit = "" if one.found.channel == "none" else " Highlighted: where the accepted effect acts."
        return f"The stages were not tested individually.{lit}"
    where = f"{one.where[0].upper()}{one.where[1:].removesuffix('.')}. " if one.where else ""
    if not one.guilty:
        return f"{where or 'No stage shows a significant fault. '}{_SIGMA}"
    return (
        f"{where}Highlighted: where an unknown input would explain most of the nominal model's "
        f"misfit; the motion carries the fault into the other stages. {_SIGMA}"
    )


_SIGMA = (
    "Percentages: the share of the misfit that an unknown input there would explain, with the "
    "robot's values re-fitted. All misfits on this page are RMS in σ, one standard deviation of "
    "the noise, so 1 is noise alone."
)


def _key_facts(one: ExplainedExperiment) -> Iterator[doc.Fact]:
    found = one.found
    yield doc.Fact("misfit before", f"{found.before:.2f} σ", one.proven_on)
    yield doc.Fact("misfit now", f"{found.after:.2f} σ", "1 is noise alone")
    for finding in found.findings[:3]:
        if found.verdict == "missing_physics":
            name = tables.candidate_words([finding.name])
            beyond = "of the misfit beyond the noise"
            yield doc.Fact(f"explained by {name}", tables.share_text(finding), beyond)
        for name, each in list(finding.parameters.items())[:2]:
            value, _, interval = tables.value_text(each).partition(" [")
            yield doc.Fact(words_of(name), value, f"95 %: {interval.rstrip(']')}")
    if isinstance(one.loss, Loss):
        lost = share_lost(one.loss)
        yield doc.Fact("speed lost", lost, "by driving the nominal model's best gait")


def _open(one: ExplainedExperiment) -> Iterator[str]:
    found = one.found
    for tie in found.ties:
        yield f"These recordings cannot distinguish {tables.tie_text(tie, found)}."
    if found.verdict != "consistent":
        yield f"Remainder: {tables.remainder_text(found.remainder)}. {found.remainder.matters}"
    yield from (each.sentence for each in found.residue)
    if found.advice:
        yield found.advice


def _summary_facts(one: ExplainedExperiment) -> Iterator[doc.Fact]:
    found = one.found
    yield doc.Fact("verdict", f"{found.verdict}: {tables.headline(found)}")
    if found.channel != "none":
        yield doc.Fact("  shows in", found.channel.replace("_", " "))
    if one.where:
        lit = next((each for each in found.stages if each.guilty), None)
        place = f"{tables.stage_name(lit)}: " if lit and lit.channel != found.channel else ""
        yield doc.Fact("  where", f"{place}{one.where}")
    for finding in found.findings:
        yield from _finding(finding, "" if found.verdict == "parameters" else "confidence")
    for finding in found.suspects:
        yield from _finding(finding, "suspected, confidence")
    proof = counted(len(one.proof), "held-out recording") if one.marked else one.proven_on
    misfit = f"{found.before:.2f} before, {found.after:.2f} after, in units of the noise"
    yield doc.Fact("misfit", f"{misfit} ({proof})")
    for stage, word in zip(found.stages, tables.stage_words(found.stages), strict=True):
        text = f"{word}, {tables.stage_text(stage, found)}"
        yield doc.Fact(f"stage {tables.stage_name(stage)}", text)
    for tie in found.ties:
        yield doc.Fact("indistinguishable", tables.tie_text(tie, found))
    if found.verdict != "consistent":
        yield doc.Fact("remainder", tables.remainder_text(found.remainder))
    for each in found.residue:
        yield doc.Fact("residual", each.sentence)
    if one.loss is not None:
        yield doc.Fact("speed lost", loss_line(one.loss))
    if found.advice:
        yield doc.Fact("record next", found.advice)
    yield doc.Fact("took", f"{sum(found.seconds.values()):.0f} s")


def _finding(finding: Finding, sure: str) -> Iterator[doc.Fact]:
    if sure:
        head = f"{sure} {finding.confidence:.2f}, explains {tables.share_text(finding)}"
        yield doc.Fact(tables.candidate_words([finding.name]), head)
    for name, value in finding.parameters.items():
        yield doc.Fact(f"  {name}", tables.value_text(value))
