"""The report of a driven route: its path, its command, and its checks."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import numpy as np

from rr_opt.documents import document as doc
from rr_opt.documents.report import Report
from rr_opt.files.record import plain
from rr_opt.formatting import number, with_unit
from rr_opt.motion.setpoints import CENTRE, COUNT
from rr_opt.outcome import Status
from rr_opt.report.captions import captions
from rr_opt.report.trajectory_file import trajectory_csv
from rr_opt.results.route import DrivenRoute

_RATE = 125.0
"""Set points a second."""


def record(result: DrivenRoute) -> dict[str, Any]:
    """The content of route.json, SI."""
    plan, replay, command = result.plan, result.replay, result.command
    return {
        "status": result.status,
        "message": result.message,
        "seconds": result.seconds,
        "direction": plan.way,
        "length": sum(leg.length for leg in plan.legs),
        "path": [plain(leg) for leg in plan.legs],
        "gaits": [
            {"amplitude": gait.amplitude, "period": gait.period, "offset": gait.offset, "speed": v}
            for gait, v in zip(plan.gaits, plan.speeds, strict=True)
        ],
        "coasting_alone": plain(plan.coasting) if plan.coasting else None,
        "command": command
        and {
            "durations": command.durations.tolist(),
            "amplitude": command.knots[0].tolist(),
            "offset": command.knots[1].tolist(),
            "omega": command.knots[2].tolist(),
        },
        "check": replay
        and {
            "position": replay.position,
            "heading": replay.heading,
            "speed": replay.speed,
            "path": replay.path,
            "reached": replay.reached,
            "excess": replay.excess,
        },
        "solver": plan.drive and {"steps": plan.drive.iterations, "converged": plan.drive.success},
        "tolerance": plain(plan.route.tolerance),
        "robot": plain(result.robot),
        "input_sha256": result.sha256,
    }


def _facts(result: DrivenRoute) -> Iterator[doc.Fact]:
    plan, replay = result.plan, result.replay
    if replay is None or result.seconds is None:
        return
    length = sum(leg.length for leg in plan.legs)
    yield doc.Fact("time", with_unit(result.seconds, "s"), f"{number(length)} m of path")
    leads = "platform 1 leads" if plan.way == "forward" else "platform 2 leads"
    yield doc.Fact("direction", plan.way, leads)
    yield doc.Fact("end", f"{1e3 * replay.position:.1f} mm from its place")
    yield doc.Fact("", f"{math.degrees(replay.heading):.2f} deg from its heading")
    yield doc.Fact("way", f"within {1e3 * replay.path:.1f} mm of the path")
    if plan.route.end == "rest":
        yield doc.Fact("speed at the end", f"{1e3 * replay.speed:.2f} mm/s")
        coast = plan.coasting
        if coast:
            text = f"{number(coast.seconds)} s and {number(coast.distance)} m to stop"
            yield doc.Fact("coasting alone", text)


def _legs(result: DrivenRoute) -> doc.Table:
    rows = []
    plan = result.plan
    for leg, gait, speed in zip(plan.legs, plan.gaits, plan.speeds, strict=True):
        way = (
            "straight"
            if leg.curvature == 0
            else f"radius {number(1 / abs(leg.curvature))} m, "
            f"{number(math.degrees(abs(leg.curvature) * leg.length))} deg to the "
            + ("left" if leg.curvature > 0 else "right")
        )
        rows.append(
            (
                str(leg.piece + 1), way, leg.length, gait.amplitude, gait.period, gait.offset,
                1e3 * speed,
            )
        )  # fmt: skip
    head = ("piece", "way", "m", "amplitude, rad", "period, s", "offset, rad", "mm/s, steady")
    note = "Steady gaits that the drive begins from; the drive changes them together."
    return doc.table(head, rows, note)


def document(result: DrivenRoute, figures: Sequence[doc.Figure] = ()) -> doc.Document:
    """The report."""
    sections = [doc.Section("", (doc.Facts(tuple(_facts(result))),))]
    if result.plan.legs:
        sections.append(doc.Section("Path", (_legs(result),)))
    if result.checks:
        checks = doc.checks((check.passed, check.sentence) for check in result.checks)
        sections.append(doc.Section("Checks", (checks,)))
    good = result.status is Status.OPTIMAL
    title = result.message if good else f"No drive: {result.status.words}"
    return doc.Document(
        result.name,
        "route",
        title,
        "" if good else result.message,
        (*sections, doc.gallery(figures)),
        good=good,
        footer=doc.versions(result.sha256),
    )


def tables(result: DrivenRoute) -> Mapping[str, str]:
    """trajectory.csv, and set points of the whole drive."""
    command = result.command
    if result.replay is None or command is None:
        return {}
    t = np.arange(math.ceil(command.seconds * _RATE) + 1) / _RATE
    phi = command.angle(np.minimum(t, command.seconds))
    counts = np.round(CENTRE + phi / COUNT).astype(int)
    columns = (t.tolist(), phi.tolist(), np.degrees(phi).tolist(), counts.tolist())
    points = doc.csv_text(("t", "phi", "phi_deg", "count"), zip(*columns, strict=True))
    return {"trajectory.csv": trajectory_csv(result.replay.trajectory), "setpoints.csv": points}


REPORT = Report(
    record,
    document,
    file="route.json",
    tables=tables,
    others=("trajectory.csv", "setpoints.csv"),
    figures="rr_opt.report.figures.route",
    captions=captions("route"),
)
