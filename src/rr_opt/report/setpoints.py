"""The report of set points: what each step from the gait to them costs in speed."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

from rr_opt.documents.document import Fact, facts_alone
from rr_opt.documents.report import Report
from rr_opt.formatting import number, speed_text, with_unit
from rr_opt.motion.setpoints import COUNT, SetPoints
from rr_opt.report.gait import gait_facts
from rr_opt.results.setpoints import ExportedGait
from rr_opt.version import __version__

MODEL = (
    "The servo is assumed to move at constant speed between set points and to reach each one when "
    "the next is sent. What its effects in `physics`, such as a lag, then make of that counts."
)

_NOTHING = 1e-6
"""A change so small, relative, is that of an optimiser's last digits."""

_STEPS = {
    "period": "by the changed period",
    "holding": "by moving in straight lines between set points",
    "rounding": f"by rounding to counts of {1e3 * COUNT:.2f} mrad",
}


def record(result: ExportedGait) -> dict[str, Any]:
    """Rate, period, and the speed lost (negative) or gained by each step, SI."""
    points, cost = result.points, result.cost
    return {
        "gait": points.gait,
        "status": result.source_status,
        "format": result.format,
        "rate": points.rate,
        "points": len(points.angles),
        "period": points.played.period,
        "speed": cost.nominal,
        "speed_left": cost.final,
        "cost": {"period": 0.0, "holding": 0.0, "rounding": None, **cost.steps},
        "model": MODEL,
        "file": None,
        "version": __version__,
    }


def _facts(result: ExportedGait) -> Iterator[Fact]:
    points, cost = result.points, result.cost
    rate = f"{with_unit(points.rate, '', 6)} a second, one every {number(1e3 / points.rate)} ms"
    yield from gait_facts(points.gait)
    yield Fact("set points", f"{len(points.angles)} a period, {rate}")
    yield Fact("  period", _period_text(points))
    yield Fact("speed", f"{speed_text(cost.nominal)}, of the gait itself")
    for name, change in cost.steps.items():
        yield Fact(f"  {name}", f"{_change_text(change, cost.nominal)} {_STEPS[name]}")
    total = _change_text(sum(cost.steps.values()), cost.nominal)
    yield Fact("  left", f"{speed_text(cost.final)}, {total}")


def _period_text(points: SetPoints) -> str:
    asked, played = points.gait.period, points.played.period
    if math.isclose(asked, played, rel_tol=_NOTHING):
        return f"{with_unit(asked, 's')}, as asked"
    return (
        f"{with_unit(played, 's', 6)}, changed from {with_unit(asked, 's', 6)} "
        f"({100 * (played / asked - 1):+.2f} %), a whole number of set points"
    )


def _change_text(change: float, nominal: float) -> str:
    """`-0.36 mm/s (-0.28 %)`: a change of a speed."""
    if abs(change) <= _NOTHING * abs(nominal):
        return "0 mm/s"
    share = f" ({100 * change / abs(nominal):+.2f} %)" if nominal else ""
    return f"{'+' if change > 0 else ''}{number(1e3 * change, 3)} mm/s{share}"


REPORT = Report(record, lambda result, _: facts_alone(_facts(result), MODEL))
