"""What the gaits of the paper ask of the servo, and where the singular posture is."""

from __future__ import annotations

import math
from dataclasses import dataclass

from rr_opt.model.robot import Robot
from rr_paper.prototype import box_grid
from rr_paper.publication import FIGURE_4, FIGURE_5, FIGURE_6, RATE_LIMIT, RPM, TABLE_3


@dataclass(frozen=True)
class ServoDemand:
    """A gait of the paper: amplitude in rad, period in s."""

    where: str
    amplitude: float
    period: float

    @property
    def of_table3(self) -> bool:
        """Whether it is a run of Table 3."""
        return self.where.startswith("Table 3")

    @property
    def rpm(self) -> float:
        """The peak rate 2 pi alpha/T, rpm."""
        return 2 * math.pi * self.amplitude / self.period * RPM

    @property
    def excess(self) -> float | None:
        """How far beyond Table 1's 30 rpm, rpm; None if it is not."""
        return self.rpm - RATE_LIMIT * RPM if self.rpm > RATE_LIMIT * RPM else None


@dataclass(frozen=True)
class SingularPosture:
    """The angle at which S1 = c1 cos phi + c2 vanishes, rad: of the robot as assumed, and the least
    and largest over the box of a1 and a2."""

    angle: float
    least: float
    largest: float


def servo_demands(table2_amplitude: float) -> tuple[ServoDemand, ...]:
    """Of every gait that the paper drove, and of the fastest corner of each surface."""
    return (
        *(
            ServoDemand(f"Table 3, row {i}", row.amplitude or math.nan, row.period)
            for i, row in enumerate(TABLE_3, 1)
        ),
        ServoDemand("Table 2, with the fitted amplitude", table2_amplitude, 1.0),
        ServoDemand("Fig. 4, largest amplitude", FIGURE_4.amplitude[1], FIGURE_4.period[0]),
        ServoDemand(
            "Fig. 5, largest at the shortest period", FIGURE_5.amplitude[1], FIGURE_5.period[0]
        ),
        ServoDemand("Fig. 6", FIGURE_6.amplitude, FIGURE_6.period),
    )


def singular_posture(robot: Robot) -> SingularPosture:
    """Where it is."""
    angles = [one.singular_angle for one in box_grid(25)]
    return SingularPosture(robot.singular_angle, min(angles), max(angles))
