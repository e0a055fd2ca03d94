"""The answer to a turn: with the arc and the check of the circle; as text, and as a folder."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from rr_opt.design.turn.fastest_turn import Arc
from rr_opt.design.turn.target import Target
from rr_opt.model.problem import ANY
from rr_opt.motion.rollout import one_period
from rr_opt.outcome import Status
from rr_opt.report.answer import Answer, Check
from rr_opt.report.archive import remove, write_json, write_text
from rr_opt.report.files import FIGURES, PAGE, RESULT, TRAJECTORY
from rr_opt.report.html import card, table
from rr_opt.report.quantities import direction_text, number, with_unit
from rr_opt.report.result import finite, result
from rr_opt.report.summary import summary
from rr_opt.report.text import columns
from rr_opt.report.trajectory_file import write_csv
from rr_opt.verify.turn.circle import LARGEST, PERIODS, CircleCheck


@dataclass(frozen=True)
class TurnAnswer(Answer):
    """What `turn` has to tell.

    target   what was asked
    opened   the problem fixed the offset, and it was opened
    arc      None where there is no gait
    circle   None where there is no gait to check
    """

    target: Target = field(default_factory=Target)
    opened: bool = False
    arc: Arc | None = None
    circle: CircleCheck | None = None

    @property
    def checks(self) -> list[Check]:
        """Those of any answer, and the circle's."""
        checks = super().checks
        if self.circle:
            checks += circle_checks(self.circle)
        return checks

    @property
    def headline(self) -> str:
        """The turn that was found."""
        arc = self.arc
        if arc is None or not super().headline:
            return ""
        return (
            f"The fastest turn found goes {direction_text(arc.speed)} and to the "
            f"{side(arc.curvature)} round {with_unit(radius(arc), 'm')} at "
            f"{1e3 * abs(arc.speed):.1f} mm/s"
        )

    @property
    def message(self) -> str:
        """The outcome in a paragraph."""
        text = super().message
        arc = self.arc
        if arc is None or self.status is not Status.OPTIMAL:
            return text
        found = "The fastest gait found drives "
        turn = (
            f"The fastest turn found goes {direction_text(arc.speed)} and to the "
            f"{side(arc.curvature)}, round a circle of radius {with_unit(radius(arc), 'm')}, "
        )
        return text.replace(found + direction_text(arc.speed) + " ", turn, 1) + self._opened()

    def _opened(self) -> str:
        bounds = self.optimum.problem.gait.offset
        return (
            " The problem fixes the offset, and a turn needs one: it was opened to all that the "
            f"limits allow, {number(bounds.low)} to {number(bounds.high)} rad."
            if self.opened
            else ""
        )


def circle_checks(circle: CircleCheck) -> list[Check]:
    """The circle's checks, and how a start from rest comes to it."""
    tail = f"(at most {LARGEST:.0e} allowed)."
    start = circle.transient
    ahead = "behind" if start.lost >= 0 else "ahead of"
    return [
        Check(
            max(circle.ends, circle.mean) <= LARGEST,
            f"{PERIODS} periods by CVODES: P is at most {circle.ends:.1e} of the radius from where "
            f"the circle has it, and the mean circle's radius differs by {circle.mean:.1e} {tail}",
        ),
        Check(
            circle.rest <= LARGEST,
            f"From rest, after {circle.periods} periods by CVODES: the radius differs by "
            f"{circle.rest:.1e} {tail} The deviation falls to 1/e in "
            f"{with_unit(start.constant, 's')}, and the robot stays "
            f"{with_unit(abs(start.lost), 'm')} {ahead} one that is steady from the start.",
        ),
    ]


def side(value: float) -> str:
    """Which way a positive or negative turn goes."""
    return "left" if value > 0 else "right"


def radius(arc: Arc) -> float:
    """m, positive."""
    return abs(1 / arc.curvature) if arc.curvature else math.inf


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
        "prices": _prices(answer),
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
        ("  radius", with_unit(radius(arc), "m")),
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
    for name, price in _prices(answer).items():
        value = getattr(answer.arc, name) if name != "heading" else _per_period(answer)
        gain = -0.01 * value * price
        if abs(gain) > 1e-9:
            rows.append(("  price", f"{1e3 * gain:+.3g} mm/s for {words[name]}"))
    return rows


def _per_period(answer: TurnAnswer) -> float:
    return answer.arc.heading / answer.arc.periods if answer.arc else 0.0


def _prices(answer: TurnAnswer) -> dict[str, float]:
    """Shadow prices of what was asked of the turn."""
    best, turn = answer.optimum.best, answer.optimum.problem.turn
    if best is None or turn is None:
        return {}
    names = ("curvature", "yaw_rate", "heading")
    return {name: best.prices[name] for name in names if getattr(turn, name) != ANY}


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
        "radius": finite(radius(arc)),
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
