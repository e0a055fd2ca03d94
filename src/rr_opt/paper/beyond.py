"""What the paper's runs and ranges ask of the servo and of the posture, against Table 1."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from rr_opt.paper.nine_rows import BOX, prototype
from rr_opt.paper.printed import FIGURE_4, FIGURE_5, FIGURE_6, TABLE_3
from rr_opt.paper.surfaces import ANGLE_LIMIT, RATE_LIMIT, RPM
from rr_opt.robot.parameters import Robot


@dataclass(frozen=True)
class Asked:
    """A gait of the paper, and its peak rate in rad/s."""

    where: str
    amplitude: float
    period: float

    @property
    def rate(self) -> float:
        """2 pi alpha/T, rad/s."""
        return 2 * math.pi * self.amplitude / self.period

    @property
    def rpm(self) -> float:
        """The peak rate in rpm."""
        return self.rate * RPM

    @property
    def too_fast(self) -> bool:
        """Beyond Table 1's 30 rpm."""
        return self.rate > RATE_LIMIT


@dataclass(frozen=True)
class Posture:
    """The singular posture S1 = c1 cos phi + c2 = 0: the angle for the robot as assumed, and the
    least and largest over the box of a1 and a2, rad; the servo's own range."""

    angle: float
    least: float
    largest: float
    servo: float = ANGLE_LIMIT


def asked(table2_amplitude: float) -> tuple[Asked, ...]:
    """Every gait that the paper drove, and the fastest corner of each surface."""
    return (
        *(
            Asked(f"Table 3, row {i}", row.amplitude or math.nan, row.period)
            for i, row in enumerate(TABLE_3, 1)
        ),
        Asked("Table 2, with the amplitude found", table2_amplitude, 1.0),
        Asked("Fig. 4, largest amplitude", FIGURE_4.amplitude[1], FIGURE_4.period[0]),
        Asked("Fig. 5, largest at the shortest period", FIGURE_5.amplitude[1], FIGURE_5.period[0]),
        Asked("Fig. 6", FIGURE_6.amplitude, FIGURE_6.period),
    )


def posture(robot: Robot) -> Posture:
    """Where the singular posture is."""
    corners = [
        prototype(float(a1), float(a2), 0.03, 0.1).singular_angle
        for a1 in np.linspace(*BOX["a1"], 25)
        for a2 in np.linspace(*BOX["a2"], 25)
    ]
    return Posture(robot.singular_angle, min(corners), max(corners))
