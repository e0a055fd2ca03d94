"""The page's tables of what was found: effects, candidates, parameters."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from rr_opt.diagnose.diagnosis import Estimate, Finding
from rr_opt.experiment.experiment import Uncertainty
from rr_opt.report.diagnosis.diagnosed import Diagnosed
from rr_opt.report.diagnosis.words import (
    candidate_words,
    interval_text,
    number_text,
    parameter_words,
    share_text,
    value_text,
)
from rr_opt.report.html import Badge, Cell, table
from rr_opt.report.robot_record import robot_record

_MOST = 30
"""Rows of candidates; diagnosis.json has all."""


def effects_table(one: Diagnosed) -> str:
    """What was accepted, with its values; nothing for a verdict without effects."""
    if one.found.verdict == "parameters" or not one.found.findings:
        return ""
    rows: list[list[Cell]] = []
    for finding in one.found.findings:
        for k, (name, value) in enumerate(finding.parameters.items()):
            first: list[Cell] = _effect_cells(finding) if k == 0 else ["", "", ""]
            rows.append([first[0], name, value_text(value), *first[1:]])
    head = ["Effect", "Parameter", "Value [95 % interval]", "Confidence", "Removes"]
    return table(head, rows)


def _effect_cells(finding: Finding) -> list[Cell]:
    removes = share_text(finding) + (", minor" if finding.minor else "")
    return [finding.name.replace("_", " "), f"{finding.confidence:.2f}", removes]


def candidates_table(one: Diagnosed) -> str:
    """All sets of effects that were fitted, the best first."""
    tried = sorted(one.found.tried, key=lambda each: each.score)
    if not tried:
        return ""
    rows: list[list[Cell]] = [
        [
            candidate_words(each.effects),
            f"+{each.score - tried[0].score:.0f}",
            f"{each.fit:.2f} σ",
            "–" if np.isnan(each.left_out) else f"{each.left_out:.2f} σ",
            Badge("accepted", "yes") if each.accepted else "",
        ]
        for each in tried[:_MOST]
    ]
    head = ["Effects", "Score over the best", "Misfit", "Misfit, left out", "Verdict"]
    return table(head, rows)


def parameters_table(one: Diagnosed) -> str:
    """The robot's own parameters: as believed, and as estimated."""
    nominal = _flat(one)
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
        verdict: list[Cell] = [Badge("not as believed", "assumed") if name in moved else ""]
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
    return table(head, rows) if rows else ""


def _believed(value: Estimate, believed: float, known: Uncertainty | None) -> str:
    text = number_text(value, believed)
    if known is None:
        return text
    if known.factor is not None:
        return f"{text}, within a factor of {known.factor:g}"
    return f"{text} ± {number_text(value, known.sigma)}"


def _known(one: Diagnosed, name: str) -> Uncertainty | None:
    return one.experiment.uncertainty.get(name)


def _flat(one: Diagnosed) -> Mapping[str, float]:
    """The nominal robot's parameters by the names of a diagnosis."""
    robot = robot_record(one.experiment.robot)
    flat = {f"{part}{i}": value for i in (1, 2) for part, value in robot[f"platform{i}"].items()}
    return flat | {"h": robot["h"]}
