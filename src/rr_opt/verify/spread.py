"""What many robots, drawn at random from those that a file may mean, make of a gait."""

from dataclasses import dataclass

import numpy as np

from rr_opt.array import Array
from rr_opt.model.gait import SineGait
from rr_opt.model.problem import Spreads
from rr_opt.model.robot import Robot
from rr_opt.motion.dynamics import dynamics_of
from rr_opt.verify.speeds import model_of, resolved

DRAWN = 20_000
_TOLERANCE = 1e-5


@dataclass(frozen=True)
class Drawn:
    """Of the robots: signed speed, m/s, and largest |torque|, N m, (K,)."""

    speed: Array
    torque: Array

    def reaching(self, speed: float) -> float:
        """The share of them that go at least as fast the same way."""
        return float((self.speed * np.sign(speed) >= abs(speed)).mean())

    def keeping(self, torque: float) -> float:
        """The share of them that need no more torque, N m."""
        return float((self.torque <= torque).mean())

    def reached(self, share: float) -> float:
        """The speed, m/s, that this share of them reaches, forward or backward as most go."""
        way = float(np.sign(np.median(self.speed)))
        return way * float(np.quantile(way * self.speed, 1 - share))


def drawn(
    robot: Robot, gait: SineGait, spreads: Spreads, scale: float = 1.0, seed: int = 1
) -> Drawn:
    """DRAWN robots; scale: of all spreads."""
    dynamics, rng, count = dynamics_of(robot), np.random.default_rng(seed), DRAWN
    p = np.repeat(dynamics.values(robot)[:, None], count, axis=1)
    for which, spread in spreads.of(dynamics.parameters).items():
        p[which] *= np.exp(scale * spread * rng.standard_normal(count))
    ones = np.ones(count)
    found = resolved(
        model_of(robot), robot, gait.amplitude * ones, gait.offset * ones,
        gait.period * ones[:, None], np.arange(count), p, _TOLERANCE,
    )  # fmt: skip
    return Drawn(found.speed[:, 0], found.peak_torque[:, 0])
