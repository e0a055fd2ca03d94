"""What Table 1 leaves out, and how much of a speed hangs on each of it."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from rr_opt.model.gait import SineGait
from rr_opt.model.robot import Robot
from rr_paper.consistency import ABOUT_P, BOX, prototype
from rr_paper.equation3 import CORRECTED, steady
from rr_paper.printed import Row

_VALUES = 41


@dataclass(frozen=True)
class LeftOut:
    """An unknown, what the prototype assumes of it, and the least and largest |speed| of a gait
    while it alone moves over its box, m/s."""

    name: str
    unit: str
    assumed: float
    low: float
    high: float
    least: float
    largest: float


def audit_left_out(robot: Robot, row: Row) -> tuple[LeftOut, ...]:
    """Move each unknown of the prototype alone, at the gait of a row of Table 3."""
    one, two = robot.platform1, robot.platform2
    own = {"a1": one.a, "a2": two.a, "b": one.b, "k": robot.k1}
    units = {"a1": "m", "a2": "m", "b": "m", "k": "N s/m"}
    gait = SineGait(row.amplitude or math.nan, row.period)
    found = []
    for name, value in own.items():
        speeds = []
        for moved in np.linspace(*BOX[name], _VALUES):
            changed = prototype(**{**own, name: float(moved)})
            speeds.append(abs(steady(ABOUT_P.build(changed, row.ratio), gait, CORRECTED).speed))
        ends = BOX[name]
        found.append(LeftOut(name, units[name], value, *ends, min(speeds), max(speeds)))
    return tuple(found)
