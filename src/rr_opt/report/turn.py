"""The fastest turn, and the circle of a gait: as documents and as records."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any

from rr_opt.answers.corrected_robot import finite
from rr_opt.answers.motion import CircleAnswer
from rr_opt.answers.quantities import number, with_unit
from rr_opt.answers.turn import TurnAnswer, side
from rr_opt.files.gait_record import gait_record
from rr_opt.motion.circle import Circle
from rr_opt.report.document import Fact, Facts, Section
from rr_opt.report.gait import gait_facts, speed_fact
from rr_opt.report.result import result
from rr_opt.report.speed import speed_document, write_speed
from rr_opt.report.text import facts_text, terminal

UNITS = {
    "heading": "rad, positive to the left",
    "curvature": "1/m, heading per metre of the mean circle",
    "yaw_rate": "rad/s",
    "length": "m, along the mean circle",
    "time": "s",
    "price of curvature, yaw_rate, heading": "m/s of |speed| per SI unit by which it is raised",
}


def turn_summary(answer: TurnAnswer, files: Iterable[Path]) -> str:
    """The report of a fastest gait, with its arc, as text for a terminal."""
    return terminal(speed_document(answer, turn=_section(answer)), files)


def write_turn(
    answer: TurnAnswer, folder: Path, *, figures: bool, progress: Callable[[str], None]
) -> list[Path]:
    """Write everything; returns the files in the order to name them."""
    record = turn_result(answer)
    return write_speed(answer, folder, record, _section(answer), figures, progress)


def turn_result(answer: TurnAnswer) -> dict[str, Any]:
    """The content of result.json: that of any fastest gait, and `turn`."""
    record, target = result(answer), answer.target
    record["turn"] = {
        "asked": {
            "heading": target.heading,
            "radius": target.radius,
            "within": target.within,
            "length": target.length,
            "cycles": "whole" if target.whole else "any",
        },
        "offset_opened": answer.opened,
        "arc": _arc(answer),
        "prices": answer.turn_prices,
        "circle_check": _circle_check(answer),
    }
    return record | {"units": {**record["units"], **UNITS}}


def _section(answer: TurnAnswer) -> Section:
    """The arc, or the full circle, and what a slightly easier turn would gain."""
    arc = answer.arc
    if arc is None:
        return Section("Turn", ())
    name = "circle" if answer.target.heading is None else "arc"
    degrees = abs(math.degrees(arc.heading))
    facts = (
        Fact(name, f"{number(degrees)} deg to the {side(arc.heading)}"),
        Fact("radius", with_unit(answer.radius or math.inf, "m")),
        Fact("time", with_unit(arc.time, "s"), f"{number(arc.periods, 6)} periods, steady motion"),
        Fact("length", f"{with_unit(arc.length, 'm')} along the mean circle"),
        Fact("yaw rate", f"{number(math.degrees(arc.yaw_rate))} deg/s"),
        *_prices(answer),
    )
    return Section("Turn", (Facts(facts),))


def _prices(answer: TurnAnswer) -> list[Fact]:
    words = {
        "curvature": "a radius 1 % wider",
        "yaw_rate": "a yaw rate 1 % lower",
        "heading": "a heading per period 1 % less",
    }
    facts: list[Fact] = []
    arc = answer.arc
    if arc is None:
        return facts
    for name, price in answer.turn_prices.items():
        value = arc.heading / arc.periods if name == "heading" else getattr(arc, name)
        gain = -0.01 * value * price
        if abs(gain) > 1e-9:
            facts.append(Fact("price", f"{1e3 * gain:+.3g} mm/s for {words[name]}"))
    return facts


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


def _circle_check(answer: TurnAnswer) -> dict[str, Any] | None:
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


def circle_summary(answer: CircleAnswer) -> str:
    """The gait, its circle, and how a start from rest converges to it."""
    circle, start = answer.circle, answer.transient
    ahead = "behind" if start.lost >= 0 else "ahead of"
    return facts_text(
        *gait_facts(answer.gait),
        speed_fact(circle.speed),
        *_circle_facts(circle),
        Fact(
            "from rest",
            f"the deviation falls to 1/e in {with_unit(start.constant, 's')}, by "
            f"{number(100 * (1 - start.factor), 3)} % a period",
        ),
        Fact(
            "lost",
            f"{with_unit(abs(start.lost), 'm')} {ahead} a robot that is steady from the start, "
            f"{with_unit(abs(start.delay), 's')}",
        ),
    )


def _circle_facts(circle: Circle) -> list[Fact]:
    if circle.centre is None:
        return [Fact("circle", f"straight: it turns by {circle.heading:.1e} rad a period")]
    x, y = (with_unit(value, "m") for value in circle.centre)
    degrees, rate = (number(math.degrees(one)) for one in (circle.heading, circle.yaw_rate))
    periods = f"{number(circle.periods_round, 6)} periods"
    return [
        Fact("circle", f"radius {with_unit(circle.radius, 'm')}", f"to the {side(circle.heading)}"),
        Fact("curvature", f"{number(circle.curvature)} 1/m"),
        Fact("centre", f"x = {x}, y = {y} in platform 1's axes at phase 0, P at the origin"),
        Fact("heading", f"{degrees} deg a period", f"{rate} deg/s"),
        Fact("full turn", with_unit(circle.time_round, "s"), periods),
    ]


def circle_record(answer: CircleAnswer) -> dict[str, Any]:
    """The same for scripts, SI; null for what a straight gait does not have."""
    circle, start = answer.circle, answer.transient
    return {
        "gait": gait_record(answer.gait),
        "speed": circle.speed,
        "curvature": circle.curvature,
        "radius": finite(circle.radius),
        "centre": list(circle.centre) if circle.centre else None,
        "heading_per_period": circle.heading,
        "yaw_rate": circle.yaw_rate,
        "time_for_full_turn": finite(circle.time_round),
        "periods_for_full_turn": finite(circle.periods_round),
        "from_rest": {
            "time_constant": start.constant,
            "factor_per_period": start.factor,
            "distance_lost": start.lost,
            "delay": start.delay,
        },
    }
