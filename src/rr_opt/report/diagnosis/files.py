"""A diagnosis as text for a terminal, and as a folder."""

from __future__ import annotations

import textwrap
from collections.abc import Callable, Sequence
from pathlib import Path

from rr_opt.answers.corrected_robot import robot_yaml
from rr_opt.answers.diagnosis import DiagnosisAnswer
from rr_opt.report.archive import remove, write_json, write_text
from rr_opt.report.diagnosis.loss import loss_line
from rr_opt.report.diagnosis.record import record
from rr_opt.report.diagnosis.words import (
    candidate_words,
    headline,
    share_text,
    size_text,
    stage_words,
    value_text,
)
from rr_opt.report.text import columns
from rr_opt.sysid.diagnosis import Finding
from rr_opt.version import __version__

_WIDTH = 100


def summary(one: DiagnosisAnswer, written: Sequence[Path]) -> str:
    """The verdict, what was found with its intervals, before and after, and what to do next."""
    found = one.found
    rows: list[tuple[str, ...]] = [("verdict", f"{found.verdict}: {headline(found)}")]
    if found.channel != "none":
        rows.append(("  shows in", found.channel.replace("_", " ")))
    if one.where:
        rows.append(("  where", one.where))
    rows += [row for finding in found.findings for row in _finding(finding, found.verdict)]
    rows += _misfit(one)
    rows += [
        (f"stage {stage.name.replace('_', ' ')}", f"{word}, {size_text(stage)}")
        for stage, word in zip(found.stages, stage_words(found.stages), strict=True)
    ]
    rows += [
        ("no telling", " or ".join(name.replace("_", " ") for name in group))
        for group in found.indistinguishable
    ]
    rows += [("left over", each.sentence) for each in found.residue]
    if one.loss is not None:
        rows.append(("lost speed", loss_line(one.loss)))
    if found.next_experiment is not None:
        rows.append(("record next", found.next_experiment.sentence))
    rows.append(("took", f"{sum(found.seconds.values()):.0f} s"))
    lines = columns(rows)
    lines += ["", *textwrap.wrap(found.summary, _WIDTH)]
    lines += ["", *(f"wrote {path}" for path in written)]
    return "\n".join(lines).rstrip() + "\n"


def _finding(finding: Finding, verdict: str) -> list[tuple[str, ...]]:
    if verdict == "parameters":
        return [(f"  {name}", value_text(value)) for name, value in finding.parameters.items()]
    minor = ", minor" if finding.minor else ""
    name = candidate_words([finding.name])
    head = f"confidence {finding.confidence:.2f}, removes {share_text(finding)}{minor}"
    values = [(f"  {key}", value_text(value)) for key, value in finding.parameters.items()]
    return [(name, head), *values]


def _misfit(one: DiagnosisAnswer) -> list[tuple[str, ...]]:
    found = one.found
    before, after = f"{found.before:.2f} sigma before", f"{found.after:.2f} after"
    if found.together is not None:
        after += f" ({found.together:.2f} with values that fit all recordings)"
    return [("misfit", f"{before}, {after}, 1 is the noise ({_proof(one)})")]


def _proof(one: DiagnosisAnswer) -> str:
    if not one.marked:
        return one.proven_on
    return f"{len(one.proof)} held out recording{'s' if len(one.proof) != 1 else ''}"


RECORD, ROBOT, PAGE = "diagnosis.json", "robot-corrected.yaml", "report.html"
FIGURES = ("evidence", "paths", "bands", "misfit", "residue", "loss")


def write_diagnosis(
    one: DiagnosisAnswer, folder: Path, *, page: bool, progress: Callable[[str], object]
) -> list[Path]:
    """Write everything; returns the files in the order to name them.

    What an earlier run left under the same names is removed before.
    """
    remove(folder, (RECORD, ROBOT, PAGE, *(f"{name}.svg" for name in FIGURES)))
    progress("the best gait, as believed and as found")
    title = f"{headline(one.found)}.\nFrom {one.name} by rr-opt {__version__} diagnose."
    written = [
        write_json(folder / RECORD, record(one)),
        write_text(folder / ROBOT, robot_yaml(one.corrected_robot, title)),
    ]
    if not page:
        return written
    progress("figures")
    # Here and not above: without figures matplotlib need not be loaded.
    from rr_opt.report.diagnosis.page import page as page_of
    from rr_opt.report.figures.diagnosis import draw

    drawn, told = draw(one)
    written += [write_text(folder / f"{name}.svg", text) for name, text in drawn.items()]
    return [write_text(folder / PAGE, page_of(one, drawn, told)), *written]
