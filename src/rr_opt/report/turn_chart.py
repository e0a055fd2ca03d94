"""The report of a turning chart: the tightest circle, and the paper's claim on the offset."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from rr_opt.documents import document as doc
from rr_opt.documents.report import Report
from rr_opt.documents.texts import captions
from rr_opt.files.record import plain
from rr_opt.formatting import number, with_unit
from rr_opt.report.gait import speed_fact
from rr_opt.results.turn_chart import TurnChart, sine_text
from rr_opt.verify.turn_chart import RadiusClaim, SignClaim

COLUMNS = (
    "amplitude", "period", "offset", "curvature", "speed", "heading_per_period", "peak_torque",
    "keeps_limits",
)  # fmt: skip


def record(chart: TurnChart) -> dict[str, Any]:
    """The content of turn-chart.json."""
    sign, radius = chart.sign, chart.radius
    return {
        "status": "charted" if chart.tight else chart.status.value,
        "message": chart.message,
        "problem": chart.name,
        "tightest": chart.tight,
        "sign_claim": {"holds": sign.holds, "holds_each_way": sign.holds_each_way} | plain(sign),
        "radius_claim": {"holds": radius.holds, **plain(radius)},
    }


def tables(chart: TurnChart) -> dict[str, str]:
    """A row for each gait, SI, offsets of both signs, or of one if the robot's two sides differ.

    Cells are empty where there is no steady cycle within the limits on the angle.
    """
    seen = chart.seen
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
    rows = zip(*(part.tolist() for part in both), strict=True)
    return {"turn-chart.csv": doc.csv_text(COLUMNS, rows)}


def document(chart: TurnChart, figures: Sequence[doc.Figure] = ()) -> doc.Document:
    """The tightest circle, and the paper's claim on the offset."""
    tight = chart.tight
    facts: tuple[doc.Section, ...] = ()
    if tight:
        circle = f"{with_unit(tight.radius, 'm')} by {sine_text(tight.gait)}"
        tightest = doc.Facts((doc.Fact("tightest", circle), speed_fact(tight.speed)))
        facts = (
            doc.Section("", (tightest,)),
            doc.Section("The sign of the offset sets the side", (_sign_facts(chart.sign),)),
            doc.Section("A larger offset makes a smaller radius", (_radius_facts(chart.radius),)),
        )
    return doc.Document(
        chart.name,
        "turn chart",
        chart.message if tight else "No gait that turns respects every limit",
        "" if tight else chart.message,
        (*facts, doc.gallery(figures)),
        good=tight is not None,
        footer=doc.versions(chart.sha256),
    )


def _sign_facts(claim: SignClaim) -> doc.Facts:
    verdict = (
        f"holds for all {claim.gaits} gaits"
        if claim.holds
        else f"fails: {claim.rarer} of {claim.gaits} gaits turn to the other side"
    )
    forward = f"{claim.forward_left} left, {claim.forward_right} right at offsets above 0"
    facts = [
        doc.Fact("verdict", verdict),
        doc.Fact("forward", forward),
        doc.Fact("backward", f"{claim.backward_left} left, {claim.backward_right} right"),
    ]
    if claim.exception:
        facts.append(doc.Fact("first at", sine_text(claim.exception)))
    return doc.Facts(tuple(facts))


def _radius_facts(claim: RadiusClaim) -> doc.Facts:
    curves = f"{claim.curves} curves of one amplitude and period"
    if claim.first is None or claim.worst is None:
        return doc.Facts((doc.Fact("verdict", f"holds on all {curves}"),))
    most = (
        "grows without bound to a straight line, where the turn changes sides"
        if math.isinf(claim.factor)
        else f"reaches {number(claim.factor)} times its least"
    )
    return doc.Facts(
        (
            doc.Fact("verdict", f"fails on {claim.growing} of {curves}"),
            doc.Fact("first at", sine_text(claim.first)),
            doc.Fact("worst", f"the radius {most}, by {sine_text(claim.worst)}"),
        )
    )


REPORT = Report(
    record,
    document,
    "turn-chart.json",
    tables=tables,
    others=("turn-chart.csv",),
    figures="rr_opt.report.figures.turn_chart",
    captions=captions("turn chart"),
)
