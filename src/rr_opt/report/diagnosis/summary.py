"""A diagnosis for a terminal."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path

from rr_opt.documents.document import Fact, facts_alone
from rr_opt.documents.rendering import terminal
from rr_opt.formatting import counted
from rr_opt.report.diagnosis import words
from rr_opt.report.diagnosis.loss import loss_line
from rr_opt.results.diagnosis import ExplainedExperiment
from rr_opt.sysid.diagnosis import Finding


def summary(one: ExplainedExperiment, written: Sequence[Path]) -> str:
    """The verdict, what was found with its intervals, before and after, and what to do next."""
    return terminal(facts_alone(_facts(one), one.found.summary), written)


def _facts(one: ExplainedExperiment) -> Iterator[Fact]:
    found = one.found
    yield Fact("verdict", f"{found.verdict}: {words.headline(found)}")
    if found.channel != "none":
        yield Fact("  shows in", found.channel.replace("_", " "))
    if one.where:
        yield Fact("  where", one.where)
    for finding in found.findings:
        yield from _finding(finding, found.verdict)
    proof = counted(len(one.proof), "held out recording") if one.marked else one.proven_on
    misfit = f"{found.before:.2f} before, {found.after:.2f} after, in units of the noise"
    yield Fact("misfit", f"{misfit} ({proof})")
    for stage, word in zip(found.stages, words.stage_words(found.stages), strict=True):
        text = f"{word}, {words.stage_text(stage, found)}"
        yield Fact(f"channel {words.stage_name(stage)}", text)
    for group in found.indistinguishable:
        yield Fact("indistinguishable", " or ".join(name.replace("_", " ") for name in group))
    if found.verdict != "consistent":
        yield Fact("remainder", words.remainder_text(found.remainder))
    for each in found.residue:
        yield Fact("left over", each.sentence)
    if one.loss is not None:
        yield Fact("lost speed", loss_line(one.loss))
    if found.next_experiment is not None:
        yield Fact("record next", found.next_experiment.sentence)
    yield Fact("took", f"{sum(found.seconds.values()):.0f} s")


def _finding(finding: Finding, verdict: str) -> Iterator[Fact]:
    if verdict != "parameters":
        minor = ", minor" if finding.minor else ""
        head = f"confidence {finding.confidence:.2f}, explains {words.share_text(finding)}{minor}"
        yield Fact(words.candidate_words([finding.name]), head)
    for name, value in finding.parameters.items():
        yield Fact(f"  {name}", words.value_text(value))
