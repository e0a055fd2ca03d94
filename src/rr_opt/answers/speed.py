"""The fastest gait with the evidence for it: its limits and bounds, the replay and the sweep."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, Literal

from rr_opt.answers.answer import Answer, Check, ignored_effects, listed
from rr_opt.answers.quantities import direction_text, pace_text
from rr_opt.design.decisions import ballast_interval
from rr_opt.design.maximize_speed import Optimum
from rr_opt.design.solve import Candidate
from rr_opt.model.ballast import inertia_ratio, with_load_count
from rr_opt.model.gait import Gait
from rr_opt.model.problem import LARGEST_EXCESS, Interval, Problem, RatioChoice
from rr_opt.model.robot import Robot
from rr_opt.motion.dynamics import ignored_in_steady_cycle
from rr_opt.outcome import Status
from rr_opt.verify.replay import Replay, replay
from rr_opt.verify.sweep import TOLERATED, SweepCheck, SweepResult, check_optimum

ACTIVE = 1e-4
"""A limit is active when the gait comes this near to it, relative to the limit."""

LARGEST_REPLAY_ERROR = 1e-6
"""Of the replayed speed, relative: the optimiser's mesh is refined until it is well below this."""

LIMIT_NAMES = ("angle", "rate", "torque", "singularity")


@dataclass(frozen=True)
class LimitRow:
    """A limit, and how near the gait comes to it.

    limit         SI; inf if there is none
    value         the extreme over the replayed cycle, SI; NaN if there is no gait
    active        whether the limit constrains the optimum
    shadow_price  m/s of |speed| gained per SI unit by which the limit is raised; 0 if inactive,
                  NaN if there is no gait
    """

    name: str
    limit: float
    value: float = math.nan
    active: bool = False
    shadow_price: float = math.nan


@dataclass(frozen=True)
class BoundRow:
    """A decision of the problem within its bounds.

    active        which bound constrains it, if one does
    shadow_price  m/s of |speed| per unit by which that bound moves up, 0 if neither is active;
                  None where no price exists: a fixed decision, or a whole number of loads
    """

    name: str
    value: float
    low: float
    high: float
    active: Literal["low", "high", "fixed"] | None
    shadow_price: float | None


@dataclass(frozen=True)
class SpeedAnswer(Answer):
    """The fastest gait of a problem.

    name           of the problem
    sha256         fingerprint of its files
    optimum        as the optimiser left it
    replay, sweep  the evidence; None where there is no optimum to check
    as_built       speed of the fastest gait of the robot as it is, m/s, where the optimum has
                   another inertia ratio; None elsewhere, and if that robot has no such gait
    """

    name: str
    sha256: str
    optimum: Optimum
    replay: Replay | None = None
    sweep: SweepCheck | None = None
    as_built: float | None = None

    @property
    def problem(self) -> Problem:
        """The problem solved."""
        return self.optimum.problem

    @property
    def gait(self) -> Gait | None:
        """The fastest gait; None if there is none."""
        return self.optimum.best.gait if self.optimum.best else None

    @property
    def speed(self) -> float | None:
        """Its mean speed, m/s, negative backward; None if there is no gait."""
        return self.optimum.best.speed if self.optimum.best else None

    @property
    def robot(self) -> Robot:
        """The robot, with the optimum's inertia ratio where that was to be chosen."""
        return self.optimum.robot or self.problem.robot

    @property
    def inertia_ratio(self) -> float | None:
        """J20/J10 of that robot, in the problem's definition; None if there is no gait."""
        return self.optimum.ratio

    @property
    def rebuilt(self) -> bool:
        """Whether the optimum has another inertia ratio than the robot as it is."""
        return self.robot.platform2 != self.problem.robot.platform2

    @cached_property
    def limits(self) -> dict[str, LimitRow]:
        """Each limit by name, in the order of the problem file."""
        return {name: self._limit(name) for name in LIMIT_NAMES}

    @cached_property
    def bounds(self) -> dict[str, BoundRow]:
        """Amplitude, period, offset, and the inertia ratio if it is a decision; empty without a
        gait."""
        best, problem = self.optimum.best, self.problem
        if best is None or self.optimum.ratio is None:
            return {}
        gait = problem.gait
        rows = {
            name: _bound(
                name, getattr(best.gait, name), getattr(gait, name), best.bound_prices[name]
            )
            for name in ("amplitude", "period", "offset")
        }
        if gait.shape != "sine":
            rows["amplitude"] = _swing(
                rows["amplitude"], best.bound_prices["amplitude"], best.speed
            )
        choice = problem.inertia_ratio
        if choice:
            whole = choice.by == "loads" and choice.loads.whole
            price = best.bound_prices["ballast"] * _share_per_ratio(problem, choice)
            rows["inertia_ratio"] = _bound(
                "inertia_ratio", self.optimum.ratio, choice.bounds, None if whole else price
            )
        return rows

    def ratio_of(self, candidate: Candidate) -> float:
        """J20/J10 of one of the optima, in the problem's definition."""
        robot, choice = self.problem.robot, self.problem.inertia_ratio
        span = ballast_interval(robot, choice)
        amount = span.low + candidate.share * (span.high - span.low)
        platform = robot.platform2
        changed = (
            with_load_count(platform, choice.loads, amount)
            if choice and choice.by == "loads"
            else replace(platform, I=amount)
        )
        return inertia_ratio(replace(robot, platform2=changed), choice.about if choice else "joint")

    @property
    def checks(self) -> list[Check]:
        """Replay by CVODES, the limits over the whole cycle, and the sweep."""
        checks = []
        if self.replay:
            error, excess = self.replay.error, self.replay.excess
            speed = (
                f"Replay by CVODES: its speed is {1e3 * self.replay.speed:+.3f} mm/s, "
                f"{error:.1e} from the optimiser's, relative "
                f"(at most {LARGEST_REPLAY_ERROR:.0e} allowed)."
            )
            worst = (
                f"the worst limit is exceeded by {excess:.1e} of its value "
                f"(at most {LARGEST_EXCESS:.0e} allowed)."
                if excess > 0
                else "no limit is exceeded."
            )
            checks += [
                Check(error <= LARGEST_REPLAY_ERROR, speed),
                Check(excess <= LARGEST_EXCESS, f"Limits over the whole cycle: {worst}"),
            ]
        if self.sweep:
            better = _sweep_sentence(self.sweep, self.problem.gait.shape)
            checks.append(Check(self.sweep.gap >= -TOLERATED, better))
            if not math.isnan(self.sweep.error):
                own = (
                    f"The sweep's own model gives the optimum {1e3 * self.sweep.speed:+.3f} "
                    f"mm/s, {self.sweep.error:.1e} from the optimiser's, relative "
                    f"(at most {TOLERATED:.0e} allowed)."
                )
                checks.append(Check(self.sweep.error <= TOLERATED, own))
        return checks

    @property
    def status(self) -> Status:
        """As the optimiser ended, unless a check failed."""
        if all(check.passed for check in self.checks):
            return self.optimum.status
        return Status.NOT_CONVERGED

    @property
    def headline(self) -> str:
        """The result in a phrase; empty if nothing was confirmed."""
        if self.status is not Status.OPTIMAL or not self.speed:
            return ""
        return f"{self._subject} at {1e3 * abs(self.speed):.1f} mm/s"

    @property
    def message(self) -> str:
        """The outcome in a paragraph; a failed check comes first."""
        failed = [check.sentence for check in self.checks if not check.passed]
        if failed:
            return "The optimum was not confirmed. " + " ".join(failed)
        best = self.optimum.best
        if best is None:
            return self.optimum.message
        first = f"{self._subject} at {pace_text(best.speed)}, and every check confirms it."
        return " ".join([first, *self.remarks])

    @property
    def remarks(self) -> list[str]:
        """What else there is to know of the gait, in sentences."""
        best = self.optimum.best
        if best is None:
            return []
        texts = []
        ignored = ignored_in_steady_cycle(self.problem.robot)
        if ignored:
            texts.append(f"Optimiser and checks ignore {listed(ignored)}.")
        ties = len(self.optimum.ties)
        if ties:
            texts.append(f"{ties} other gait{'s are' if ties > 1 else ' is'} as fast: a tie.")
        sine = self.optimum.sine
        if sine:
            gain = 100 * (abs(best.speed) / sine - 1)
            texts.append(f"That is {gain:.1f} % faster than the fastest sine.")
        texts += self._servo_note(best.gait)
        if self.sweep and math.isnan(self.sweep.error):
            texts.append("The sweep's own model cannot represent this shape and does not check it.")
        if self.optimum.sideways:
            texts.append(
                "It sits where forward turns into backward: its mean velocity is at right angles "
                "to its mean heading, and its direction is a matter of definition."
            )
        return texts

    @property
    def warnings(self) -> tuple[str, ...]:
        """Which effects of the robot the optimum ignores."""
        return ignored_effects(self.problem.robot)

    @property
    def _subject(self) -> str:
        return f"The fastest gait found drives {direction_text(self.speed or 0.0)}"

    def _limit(self, name: str) -> LimitRow:
        best, limit = self.optimum.best, getattr(self.problem.limits, name)
        if self.replay is None or best is None:
            return LimitRow(name, limit)
        value, price = self.replay.reached[name], best.prices[name]
        slack = value - limit if name == "singularity" else limit - value
        active = bool(math.isfinite(limit) and slack <= ACTIVE * abs(limit))
        if self.problem.gait.shape != "sine":
            # Its peaks may stay short of a limit that the program holds somewhat tighter.
            active |= _matters(price, limit, best.speed)
        return LimitRow(name, limit, value, active, price if active else 0.0)

    def _servo_note(self, gait: Gait) -> list[str]:
        """What the problem's limits allow beyond the servo of the robot file."""
        servo, needed = self.problem.robot.servo, self.replay.reached if self.replay else {}
        beyond = [
            name
            for name, value, able in (
                ("angle", gait.peak_angle, servo.angle_limit),
                ("rate", gait.peak_rate, servo.rate_limit),
                ("torque", needed.get("torque", 0.0), servo.torque_limit),
            )
            if value > able * (1 + LARGEST_EXCESS)
        ]
        if not beyond:
            return []
        return [
            "But the problem allows more than the robot's servo: the gait exceeds its "
            f"{listed(beyond)} limit."
        ]


def evidence(
    optimum: Optimum, progress: Callable[[str], Any], swept: SweepResult | None = None
) -> tuple[Replay | None, SweepCheck | None]:
    """The replay of an optimum and the sweep against it; None and None if there is no optimum.

    swept  a sweep of the whole problem, where that is done already
    """
    best, robot, ratio = optimum.best, optimum.robot, optimum.ratio
    if best is None or robot is None or ratio is None:
        return None, None
    progress("replay by CVODES")
    replayed = replay(robot, best.gait, optimum.problem.limits, best.speed)
    progress("check against a sweep")
    check = check_optimum(optimum.problem, best.gait, ratio, best.speed, everywhere=swept)
    return replayed, check


def _bound(name: str, value: float, box: Interval, price: float | None) -> BoundRow:
    if box.fixed:
        return BoundRow(name, value, box.low, box.high, "fixed", None)
    near = ACTIVE * min(box.high - box.low, max(abs(box.low), abs(box.high)))
    side: Literal["low", "high"] | None = None
    if value - box.low <= near:
        side = "low"
    elif box.high - value <= near:
        side = "high"
    return BoundRow(name, value, box.low, box.high, side, price if side else 0.0)


def _matters(price: float, limit: float, speed: float) -> bool:
    """Whether dropping the limit would change the speed by more than solvers leave behind."""
    return math.isfinite(limit) and abs(price * limit) > ACTIVE * abs(speed)


def _swing(row: BoundRow, price: float, speed: float) -> BoundRow:
    """The row of the amplitude of a gait that is no sine: the lower bound is on its first
    harmonic and the upper one on its swing, so the price shows which is active."""
    if row.active == "fixed":
        return row
    side: Literal["low", "high"] = "high" if price > 0 else "low"
    edge = row.high if price > 0 else row.low
    active = side if _matters(price, edge, speed) else None
    return replace(row, active=active, shadow_price=price)


def _share_per_ratio(problem: Problem, choice: RatioChoice) -> float:
    """How far the ballast's share of its range moves per unit of J20/J10, at the upper bound."""
    robot, high = problem.robot, choice.bounds.high

    def amount(ratio: float) -> float:
        fixed = RatioChoice(Interval(ratio, ratio), choice.about, choice.by, choice.loads)
        return ballast_interval(robot, fixed).high

    span = ballast_interval(robot, choice)
    if span.fixed:
        return 0.0
    return (amount(high) - amount(high * (1 - 1e-6))) / (high * 1e-6) / (span.high - span.low)


def _sweep_sentence(sweep: SweepCheck, shape: str) -> str:
    gaits = "gaits" if shape == "sine" else "sines"
    if sweep.best_gait is None:
        return f"Sweep of {sweep.points} {gaits}: none of them respects every limit."
    head = f"Sweep of {sweep.points} {gaits}: the best has {1e3 * sweep.best_speed:+.3f} mm/s, "
    if abs(sweep.gap) < 1e-6:
        return head + "as fast as the optimum to within a millionth."
    if sweep.gap >= 0:
        return head + f"{100 * sweep.gap:.2g} % slower than the optimum."
    return (
        head + f"{-100 * sweep.gap:.2g} % faster than the optimum "
        f"(at most {100 * TOLERATED:g} % allowed)."
    )
