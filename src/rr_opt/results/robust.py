"""The gait that is fast across the robot's uncertainty, beside the nominal optimum."""

from dataclasses import dataclass, replace
from itertools import starmap
from typing import Any

import numpy as np

from rr_opt.design.maximize_speed import Optimum
from rr_opt.design.robust import RELIABLE, RobustGait, robust_gait
from rr_opt.documents import document as doc
from rr_opt.files.record import plain
from rr_opt.formatting import number, with_unit
from rr_opt.model.ballast import inertia_ratio
from rr_opt.model.gait import Gait, SineGait
from rr_opt.model.problem import Spreads
from rr_opt.results.fastest import FastestGait
from rr_opt.results.result import Check
from rr_opt.verify.speeds import DRAWN, drawn

_ALIKE = 1e-6
SHORT = 0.01
"""Tolerated shortfall of the share of validation robots that reach the speed and keep the torque
limit; four standard deviations of it."""


@dataclass(frozen=True)
class Robust:
    """The robust gait, as commanded, and its performance beside that of the nominal optimum.

    speed      reached by 95 % of the robots with the robust gait, m/s, negative backward
    nominal    its speed on the nominal robot
    without    reached by 95 % with the nominal optimum; certainty gives up nominal speed for this
    kept       the share of the robots that keep the torque limit with the nominal optimum
    reaching   the share of validation robots that reach the speed with the robust gait;
               `keeping`: that keep the torque limit
    scales, curves  speeds reached by 95 % with the robust gait and with the nominal optimum if all
               spreads are scaled by these factors
    """

    gait: Gait
    ratio: float
    speed: float
    nominal: float
    without: float
    kept: float
    reaching: float
    keeping: float
    scales: tuple[float, ...]
    curves: tuple[tuple[float, ...], tuple[float, ...]]

    @property
    def check(self) -> Check:
        """A check on robots other than those that the speed was computed from."""
        share = f"{100 * RELIABLE:g} %"
        return Check(
            min(self.reaching, self.keeping) >= RELIABLE - SHORT,
            f"{DRAWN} other robots drawn: {100 * self.reaching:.1f} % reach the speed that "
            f"{share} should reach with the robust gait, and {100 * self.keeping:.1f} % keep "
            f"the torque limit (tolerance {100 * SHORT:g} %).",
        )

    def sentence(self, best: float) -> str:
        """The price of certainty; best: the speed of the nominal optimum, m/s."""
        speed, without = (1e3 * abs(one) for one in (self.speed, self.without))
        slower = 1 - abs(self.nominal / best)
        first = f"95 % of robots within its uncertainty reach {speed:.1f} mm/s with "
        if slower < _ALIKE:
            return f"{first}it, and no other gait does better."
        return (
            f"{first}the robust gait, which is {100 * slower:.2g} % slower on the nominal robot. "
            f"With the nominal gait they reach {without:.1f} mm/s, and {100 * self.kept:.0f} % "
            "keep the torque limit."
        )

    def section(self) -> doc.Section:
        """The section of the report."""
        rows = [
            ("amplitude", with_unit(self.gait.amplitude, "rad")),
            ("period", with_unit(self.gait.period, "s")),
            ("offset", with_unit(self.gait.offset, "rad")),
            ("J20/J10", number(self.ratio)),
            ("95 % reach", f"{1e3 * self.speed:+.2f} mm/s"),
            ("nominal", f"{1e3 * self.nominal:+.2f} mm/s"),
        ]
        return doc.section("Robust gait", doc.facts(starmap(doc.Fact, rows)))

    def record(self) -> dict[str, Any]:
        """As plain data."""
        return {
            "gait": plain(self.gait),
            "inertia_ratio": self.ratio,
            "share": RELIABLE,
            "method": "second-order expansion; the speed is read from robots drawn at random",
            "speed": self.speed,
            "speed_nominal": self.nominal,
            "speed_of_nominal_gait": self.without,
            "torque_kept_by_nominal_gait": self.kept,
            "check": {"robots": DRAWN, "reaching": self.reaching, "keeping": self.keeping},
        }


_MARGIN, _TIGHTENED = 1e-3, 6
"""Margin on the share of robots that keep the limit, so that the next try succeeds; most tries."""
_SCALES = tuple(np.linspace(0.0, 2.0, 9).tolist())


def robust_answer(best: FastestGait, spreads: Spreads) -> Robust | None:
    """The robust gait beside the nominal optimum, both evaluated on robots drawn at random."""
    torque, choice = best.problem.limits.torque, best.problem.inertia_ratio
    nominal = best.optimum.best.gait if best.optimum.best else None
    if not isinstance(nominal, SineGait):
        return None
    found = _kept_by_most(best.optimum, spreads)
    if found is None:
        return None
    gaits = (found.robot, found.gait), (best.robot, nominal)
    seen, mine = (drawn(*one, spreads) for one in gaits)
    other, speed = drawn(found.robot, found.gait, spreads, seed=2), seen.reached(RELIABLE)
    first, second = (
        tuple(drawn(*one, spreads, scale).reached(RELIABLE) for scale in _SCALES) for one in gaits
    )
    return Robust(
        gait=best.command_for(found.gait),
        ratio=inertia_ratio(found.robot, choice.about if choice else "joint"),
        speed=speed,
        nominal=found.nominal,
        without=mine.reached(RELIABLE),
        kept=mine.keeping(torque),
        reaching=other.reaching(speed),
        keeping=other.keeping(torque),
        scales=_SCALES,
        curves=(first, second),
    )


def _kept_by_most(optimum: Optimum, spreads: Spreads) -> RobustGait | None:
    """The robust gait, with the torque limit tightened until enough of the drawn robots keep it."""
    problem, torque = optimum.problem, optimum.problem.limits.torque
    tightened = torque
    for _ in range(_TIGHTENED):
        limits = replace(problem.limits, torque=tightened)
        found = robust_gait(replace(optimum, problem=replace(problem, limits=limits)), spreads)
        if found is None:
            return None
        seen = drawn(found.robot, found.gait, spreads)
        if seen.keeping(torque) >= RELIABLE:
            return found
        tightened *= torque / float(np.quantile(seen.torque, RELIABLE + _MARGIN))
    return None
