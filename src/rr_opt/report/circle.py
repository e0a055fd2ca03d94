"""The report of the circle that a gait drives."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

from rr_opt.documents.document import Fact, facts_alone
from rr_opt.documents.report import Report
from rr_opt.formatting import number, side_text, with_unit
from rr_opt.report.gait import gait_facts, speed_fact
from rr_opt.results.motion import DrivenCircle


def record(driven: DrivenCircle) -> dict[str, Any]:
    """Radius, centre, speed and the transient, SI; null for what a straight gait lacks."""
    circle, start = driven.circle, driven.transient
    return {
        "gait": driven.gait,
        "speed": circle.speed,
        "curvature": circle.curvature,
        "radius": circle.radius,
        "centre": circle.centre,
        "heading_per_period": circle.heading,
        "yaw_rate": circle.yaw_rate,
        "time_for_full_turn": circle.time_round,
        "periods_for_full_turn": circle.periods_round,
        "from_rest": {
            "time_constant": start.constant,
            "factor_per_period": start.factor,
            "distance_lost": start.lost,
            "delay": start.delay,
        },
    }


def _facts(driven: DrivenCircle) -> Iterator[Fact]:
    circle, start = driven.circle, driven.transient
    yield from gait_facts(driven.gait)
    yield speed_fact(circle.speed)
    if circle.centre is None:
        yield Fact("circle", f"straight: it turns by {circle.heading:.1e} rad a period")
    else:
        x, y = (with_unit(value, "m") for value in circle.centre)
        degrees, rate = (number(math.degrees(a)) for a in (circle.heading, circle.yaw_rate))
        radius, side = with_unit(circle.radius, "m"), side_text(circle.heading)
        periods = f"{number(circle.periods_round, 6)} periods"
        at = f"x = {x}, y = {y} in platform 1's axes at phase 0, P at the origin"
        yield Fact("circle", f"radius {radius}", f"to the {side}")
        yield Fact("curvature", f"{number(circle.curvature)} 1/m")
        yield Fact("centre", at)
        yield Fact("heading", f"{degrees} deg a period", f"{rate} deg/s")
        yield Fact("full turn", with_unit(circle.time_round, "s"), periods)
    yield Fact(
        "from rest",
        f"the deviation falls to 1/e in {with_unit(start.constant, 's')}, by "
        f"{number(100 * (1 - start.factor), 3)} % a period",
    )
    ahead = "behind" if start.lost >= 0 else "ahead of"
    yield Fact(
        "lost",
        f"{with_unit(abs(start.lost), 'm')} {ahead} a robot that is steady from the start, "
        f"{with_unit(abs(start.delay), 's')}",
    )


REPORT = Report(record, lambda driven, _: facts_alone(_facts(driven)))
