"""An experiment: a robot as its builder believes it to be, and the runs recorded of it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal

from rr_opt.experiment.recording import Recording
from rr_opt.robot.gait import Gait
from rr_opt.robot.parameters import Robot

Use = Literal["fit", "holdout"]
Start = Literal["rest", "running"]


@dataclass(frozen=True)
class Noise:
    """Standard deviation of the capture system: position (m), angle (rad); torque (N m)."""

    position: float
    angle: float
    torque: float = 0.003

    def of(self, channel: str) -> float:
        """That of x, y, psi, phi or torque."""
        if channel == "torque":
            return self.torque
        return self.position if channel in ("x", "y") else self.angle


@dataclass(frozen=True)
class Uncertainty:
    """How well a nominal value is known.

    sigma   one standard deviation, SI; with `factor` it is none
    factor  the value is free between value/factor and value*factor, and no more is known of it
    """

    sigma: float = 0.0
    factor: float | None = None


@dataclass(frozen=True)
class Run:
    """One recording and how it was made.

    gait   what the servo was told, its clock starting at the recording's t = 0
    start  `rest`: the robot stood still until t = 0 and the command began there; `running`: the
           command began a whole number of periods earlier
    use    `fit` or `holdout`
    """

    recording: Recording
    gait: Gait
    use: Use = "fit"
    start: Start = "running"

    @property
    def name(self) -> str:
        """The name of its file."""
        return self.recording.name


@dataclass(frozen=True)
class Experiment:
    """The nominal robot, how well it is known, and the runs, all in one floor frame.

    uncertainty  by parameter: m1, I1, c1, a1, b1, kappa1, m2, ..., kappa2, h, psi_zero, phi_zero.
                 What is not named is exact
    """

    robot: Robot
    noise: Noise
    uncertainty: Mapping[str, Uncertainty]
    runs: tuple[Run, ...]
    name: str = ""
