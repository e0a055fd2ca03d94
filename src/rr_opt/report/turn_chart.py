"""The turning chart of a robot: what was found, as text, as a record and as a table."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np

from rr_opt.answers.corrected_robot import finite
from rr_opt.answers.quantities import number, with_unit
from rr_opt.answers.turn_chart import TurnChartAnswer, sine_text
from rr_opt.files.gait_record import gait_record
from rr_opt.report.archive import remove, write_json, write_text
from rr_opt.report.document import Document, Fact, Facts, Section, csv_text
from rr_opt.report.gait import speed_fact
from rr_opt.report.text import terminal
from rr_opt.verify.turn_chart import RadiusClaim, SignClaim, TurnMap
from rr_opt.version import __version__

_NAMES = ("turn-chart.json", "turn-chart.csv", "turn-chart.svg")
_COLUMNS = (
    "amplitude", "period", "offset", "curvature", "speed", "heading_per_period", "peak_torque",
    "keeps_limits",
)  # fmt: skip


def chart_summary(chart: TurnChartAnswer, files: list[Path]) -> str:
    """The chart as text for a terminal."""
    tight = chart.tight
    sections: tuple[Section, ...] = ()
    if tight:
        circle = f"{with_unit(tight.radius, 'm')} by {sine_text(tight.gait)}"
        facts = (Fact("tightest", circle), speed_fact(tight.speed))
        sections = (
            Section("", (Facts(facts),)),
            Section("The sign of the offset sets the side", (_sign_facts(chart.sign),)),
            Section("A larger offset makes a smaller radius", (_radius_facts(chart.radius),)),
        )
    title = chart.message if tight else chart.status.value
    return terminal(Document(chart.name, "turn chart", title, "", sections), files)


def _sign_facts(claim: SignClaim) -> Facts:
    verdict = (
        f"holds for all {claim.gaits} gaits"
        if claim.holds
        else f"fails: {claim.rarer} of {claim.gaits} gaits turn to the other side"
    )
    facts = [
        Fact("verdict", verdict),
        Fact(
            "forward", f"{claim.forward_left} left, {claim.forward_right} right at offsets above 0"
        ),
        Fact("backward", f"{claim.backward_left} left, {claim.backward_right} right"),
    ]
    if claim.exception:
        facts.append(Fact("first at", sine_text(claim.exception)))
    return Facts(tuple(facts))


def _radius_facts(claim: RadiusClaim) -> Facts:
    curves = f"{claim.curves} curves of one amplitude and period"
    if claim.first is None or claim.worst is None:
        return Facts((Fact("verdict", f"holds on all {curves}"),))
    most = (
        "grows without bound to a straight line, where the turn changes sides"
        if math.isinf(claim.factor)
        else f"reaches {number(claim.factor)} times its least"
    )
    return Facts(
        (
            Fact("verdict", f"fails on {claim.growing} of {curves}"),
            Fact("first at", sine_text(claim.first)),
            Fact("worst", f"the radius {most}, by {sine_text(claim.worst)}"),
        )
    )


def chart_record(chart: TurnChartAnswer) -> dict[str, Any]:
    """The content of turn-chart.json, SI."""
    tight, sign, radius = chart.tight, chart.sign, chart.radius
    return {
        "status": "charted" if tight else chart.status.value,
        "message": chart.message,
        "problem": chart.name,
        "tightest": {
            "radius": tight.radius,
            "error": finite(tight.error),
            "gait": gait_record(tight.gait),
            "speed": tight.speed,
        }
        if tight
        else None,
        "sign_claim": {
            "holds": sign.holds,
            "holds_each_way": sign.holds_each_way,
            "gaits": sign.gaits,
            "forward_left": sign.forward_left,
            "forward_right": sign.forward_right,
            "backward_left": sign.backward_left,
            "backward_right": sign.backward_right,
            "exception": gait_record(sign.exception) if sign.exception else None,
        },
        "radius_claim": {
            "holds": radius.holds,
            "curves": radius.curves,
            "growing": radius.growing,
            "first": gait_record(radius.first) if radius.first else None,
            "factor": finite(radius.factor),
            "worst": gait_record(radius.worst) if radius.worst else None,
        },
        "version": __version__,
        "input_sha256": chart.sha256,
    }


def write_chart(chart: TurnChartAnswer, folder: Path) -> list[Path]:
    """Write everything; what an earlier run left is removed before."""
    from rr_opt.report.figures.turn_chart import draw

    remove(folder, _NAMES)
    return [
        write_json(folder / _NAMES[0], chart_record(chart)),
        write_text(folder / _NAMES[1], _csv(chart.seen)),
        write_text(folder / _NAMES[2], draw(chart.seen, chart.tight)),
    ]


def _csv(seen: TurnMap) -> str:
    """A row a gait, SI, offsets of both signs, or of one if the robot's two sides differ; empty
    where there is no steady cycle within the limits on the angle."""
    alpha, T, phi0 = np.meshgrid(seen.amplitude, seen.period, seen.offset, indexing="ij")
    arrays = (alpha, T, phi0, seen.curvature, seen.speed, seen.heading, seen.peak_torque)
    parts = [*arrays, seen.keeps.astype(int)]
    # phi0 and -phi0 are mirror images: what turns has the other sign there.
    left = slice(None, 0, -1) if seen.two_sided else slice(0, 0)
    mirror = [-part if i in (2, 3, 5) else part for i, part in enumerate(parts)]
    both = [
        np.concatenate([there[..., left], here], axis=-1).ravel() + 0
        for here, there in zip(parts, mirror, strict=True)
    ]
    return csv_text(_COLUMNS, zip(*(part.tolist() for part in both), strict=True))
