"""The circle of a gait and the start from rest, as text for a terminal and as a record."""

from __future__ import annotations

import math
from typing import Any

from rr_opt.answers.corrected_robot import finite
from rr_opt.answers.motion import CircleAnswer
from rr_opt.answers.quantities import direction_text, number, speed_text, with_unit
from rr_opt.files.gait_record import gait_record
from rr_opt.motion.circle import Circle
from rr_opt.report.text import columns, gait_formula, gait_lines


def circle_summary(answer: CircleAnswer) -> str:
    """The gait, its circle, and how a start from rest comes to it."""
    gait, circle, start = answer.gait, answer.circle, answer.transient
    way = direction_text(circle.speed)
    leads = "platform 1 leads" if circle.speed > 0 else "platform 2 leads"
    ahead = "behind" if start.lost >= 0 else "ahead of"
    rows = [
        ("gait", gait_formula(gait)),
        *gait_lines(gait),
        ("speed", f"{speed_text(circle.speed)} along the circle, {way}: {leads}"),
        *_circle_rows(circle),
        ("from rest", f"the deviation falls to 1/e in {with_unit(start.constant, 's')}, by "
            f"{number(100 * (1 - start.factor), 3)} % a period"),
        ("  lost", f"{with_unit(abs(start.lost), 'm')} {ahead} a robot that is steady from the "
            f"start, {with_unit(abs(start.delay), 's')}"),
    ]  # fmt: skip
    return "\n".join(columns(rows)) + "\n"


def _circle_rows(circle: Circle) -> list[tuple[str, str]]:
    if circle.centre is None:
        return [("circle", f"straight: it turns by {circle.heading:.1e} rad a period")]
    side = "left" if circle.heading > 0 else "right"
    x, y = (with_unit(value, "m") for value in circle.centre)
    return [
        ("circle", f"radius {with_unit(circle.radius, 'm')}, to the {side}"),
        ("  curvature", f"{number(circle.curvature)} 1/m"),
        ("  centre", f"x = {x}, y = {y} in platform 1's axes at phase 0, P at the origin"),
        ("  heading", f"{number(math.degrees(circle.heading))} deg a period, "
            f"{number(math.degrees(circle.yaw_rate))} deg/s"),
        ("  full turn", f"{with_unit(circle.time_round, 's')}, "
            f"{number(circle.periods_round, 6)} periods"),
    ]  # fmt: skip


def circle_record(answer: CircleAnswer) -> dict[str, Any]:
    """The same for scripts, SI; null for what a straight gait does not have."""
    gait, circle, start = answer.gait, answer.circle, answer.transient
    return {
        "gait": gait_record(gait),
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
