"""The answer to a turn as text, and as a folder."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any

from rr_opt.answers.corrected_robot import finite
from rr_opt.answers.quantities import number, with_unit
from rr_opt.answers.turn import TurnAnswer, side
from rr_opt.motion.rollout import one_period
from rr_opt.report.archive import remove, write_json, write_text
from rr_opt.report.files import FIGURES, PAGE, RESULT, TRAJECTORY
from rr_opt.report.html import card, table
from rr_opt.report.result import result
from rr_opt.report.summary import summary
from rr_opt.report.text import columns
from rr_opt.report.trajectory_file import write_csv

UNITS = {
    "heading": "rad, positive to the left",
    "curvature": "1/m, heading per metre of the mean circle",
    "yaw_rate": "rad/s",
    "length": "m, along the mean circle",
    "time": "s",
    "price of curvature, yaw_rate, heading": "m/s of |speed| per SI unit by which it is raised",
}


def turn_summary(answer: TurnAnswer, files: Iterable[Path]) -> str:
    """The summary of any answer, with the arc after its first sentence."""
    head, *rest = summary(answer, files).split("\n\n")
    arc = columns(arc_rows(answer))
    return "\n\n".join([head, *(["\n".join(arc)] if arc else []), *rest])


def turn_result(answer: TurnAnswer) -> dict[str, Any]:
    """The content of result.json: that of any answer, and `turn`."""
    record = result(answer)
    record["turn"] = {
        "asked": _asked(answer),
        "offset_opened": answer.opened,
        "arc": _arc(answer),
        "prices": answer.turn_prices,
        "circle_check": _circle(answer),
    }
    return record | {"units": {**record["units"], **UNITS}}


def arc_rows(answer: TurnAnswer) -> list[tuple[str, str]]:
    """The arc, or the full circle, and what a little less of the turn is worth."""
    arc = answer.arc
    if arc is None:
        return []
    name = "circle" if answer.target.heading is None else "arc"
    degrees = abs(math.degrees(arc.heading))
    return [
        (name, f"{number(degrees)} deg to the {side(arc.heading)}"),
        ("  radius", with_unit(answer.radius or math.inf, "m")),
        (
            "  time",
            f"{with_unit(arc.time, 's')}, {number(arc.periods, 6)} periods, in steady motion",
        ),
        ("  length", f"{with_unit(arc.length, 'm')} along the mean circle"),
        ("  yaw rate", f"{number(math.degrees(arc.yaw_rate))} deg/s"),
        *_price_rows(answer),
    ]


def _price_rows(answer: TurnAnswer) -> list[tuple[str, str]]:
    """What a little less of the turn is worth, where the turn holds the gait."""
    words = {
        "curvature": "a radius 1 % wider",
        "yaw_rate": "a yaw rate 1 % lower",
        "heading": "a heading per period 1 % less",
    }
    rows = []
    for name, price in answer.turn_prices.items():
        value = getattr(answer.arc, name) if name != "heading" else _per_period(answer)
        gain = -0.01 * value * price
        if abs(gain) > 1e-9:
            rows.append(("  price", f"{1e3 * gain:+.3g} mm/s for {words[name]}"))
    return rows


def _per_period(answer: TurnAnswer) -> float:
    return answer.arc.heading / answer.arc.periods if answer.arc else 0.0


def _asked(answer: TurnAnswer) -> dict[str, Any]:
    target = answer.target
    return {
        "heading": target.heading,
        "radius": target.radius,
        "within": target.within,
        "length": target.length,
        "cycles": "whole" if target.whole else "any",
    }


def _arc(answer: TurnAnswer) -> dict[str, Any] | None:
    arc = answer.arc
    if arc is None:
        return None
    return {
        "heading": arc.heading,
        "radius": finite(answer.radius or math.inf),
        "curvature": arc.curvature,
        "yaw_rate": arc.yaw_rate,
        "speed": arc.speed,
        "length": arc.length,
        "time": arc.time,
        "periods": arc.periods,
    }


def _circle(answer: TurnAnswer) -> dict[str, Any] | None:
    circle = answer.circle
    if circle is None:
        return None
    start = circle.transient
    return {
        "ends": circle.ends,
        "mean": circle.mean,
        "rest": circle.rest,
        "rest_periods": circle.periods,
        "time_constant": start.constant,
        "distance_lost": start.lost,
        "delay": start.delay,
    }


def write_turn(
    answer: TurnAnswer, folder: Path, *, figures: bool, progress: Callable[[str], None]
) -> list[Path]:
    """Write everything; returns the files in the order to name them.

    What an earlier run left under the same names is removed before.
    """
    remove(folder, (RESULT, TRAJECTORY, PAGE, *(f"{name}.svg" for name in FIGURES)))
    written = [write_json(folder / RESULT, turn_result(answer))]
    if answer.replay:
        written.append(write_csv(folder / TRAJECTORY, one_period(answer.replay.steady)))
    if not figures:
        return written
    progress("figures")
    # Here and not above: without figures matplotlib need not be loaded.
    from rr_opt.report.figures.answer import draw
    from rr_opt.report.page import page

    drawn = draw(answer)
    for name, svg in drawn.items():
        written.append(write_text(folder / f"{name}.svg", svg))
    rows = [[name.strip(), text] for name, text in arc_rows(answer)]
    first = card("Turn", table(["Quantity", "Value"], rows)) if rows else ""
    return [write_text(folder / PAGE, page(answer, drawn, first)), *written]
