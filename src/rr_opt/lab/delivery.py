"""How the recordings of a case are handed over."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import PurePath
from typing import Literal

from rr_opt.lab.case import Plan
from rr_opt.lab.servo_log import ServoClock

Form = Literal["csv", "vicon", "c3d"]


@dataclass(frozen=True)
class Delivery:
    """The files of a run.

    form       `csv` has the joint and the angles; `vicon` and `c3d` have the markers
    servo_log  whether each run comes with the servo's log; clock, that log's own
    torque     whether the servo's torque is in the CSV
    """

    form: Form = "csv"
    servo_log: bool = False
    clock: ServoClock = field(default_factory=ServoClock)
    torque: bool = False

    def file(self, plan: Plan) -> str:
        """The name of a run's recording."""
        return PurePath(plan.name).stem + (".c3d" if self.form == "c3d" else ".csv")

    def log(self, plan: Plan) -> str:
        """The name of a run's servo log."""
        return f"{PurePath(plan.name).stem}-servo.csv"
