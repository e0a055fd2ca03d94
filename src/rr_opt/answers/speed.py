"""The fastest gait with the evidence for it: what the replay and the sweep say of it."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Literal

from rr_opt.answers.quantities import direction_text, pace_text
from rr_opt.design.decisions import ballast_interval
from rr_opt.design.maximize_speed import Optimum
from rr_opt.design.solve import Candidate
from rr_opt.model.ballast import inertia_ratio, with_load_count
from rr_opt.model.gait import Gait
from rr_opt.model.problem import LARGEST_EXCESS, Interval, Problem, RatioChoice
from rr_opt.outcome import Status
from rr_opt.verify.replay import Replay
from rr_opt.verify.sweep import TOLERATED, SweepCheck

if TYPE_CHECKING:
    from collections.abc import Callable

    from rr_opt.verify.sweep import SweepResult


def ratio_of(optimum: Optimum, candidate: Candidate) -> float:
    """J20/J10 of one of the optima, in the problem's definition."""
    problem, choice = optimum.problem, optimum.problem.inertia_ratio
    span = ballast_interval(problem.robot, choice)
    amount = span.low + candidate.share * (span.high - span.low)
    platform = problem.robot.platform2
    changed = (
        with_load_count(platform, choice.loads, amount)
        if choice and choice.by == "loads"
        else replace(platform, I=amount)
    )
    return inertia_ratio(
        replace(problem.robot, platform2=changed), choice.about if choice else "joint"
    )


ACTIVE = 1e-4
"""A limit is active when the gait comes this near to it, relative to the limit."""

LIMIT_NAMES = ("angle", "rate", "torque", "singularity")


@dataclass(frozen=True)
class LimitRow:
    """A limit: what the gait reaches, SI (seen in the replay), and the speed gained per unit.

    limit   inf if there is none
    price   m/s of |speed| per SI unit by which the limit is raised; 0 if it is not active
    """

    name: str
    value: float
    limit: float
    active: bool
    price: float


@dataclass(frozen=True)
class BoundRow:
    """A decision of the problem within its bounds.

    side   which bound holds it, if one does
    price  m/s of |speed| per unit by which that bound moves up; None where no price exists: a
           decision that is fixed, or a whole number of loads
    """

    name: str
    value: float
    low: float
    high: float
    side: Literal["low", "high", "fixed"] | None
    price: float | None


def limit_rows(optimum: Optimum, replay: Replay) -> list[LimitRow]:
    """A row for each limit, in the order of the problem file."""
    rows = []
    for name in LIMIT_NAMES:
        limit, value = getattr(optimum.problem.limits, name), replay.reached[name]
        slack = value - limit if name == "singularity" else limit - value
        price = optimum.best.prices[name] if optimum.best else 0.0
        active = bool(math.isfinite(limit) and slack <= ACTIVE * abs(limit))
        if optimum.problem.gait.shape != "sine" and optimum.best:
            # Its peaks may stay short of a limit that the program holds somewhat tighter.
            active |= _matters(price, limit, optimum.best.speed)
        price = price if active else 0.0
        rows.append(LimitRow(name, value, limit, active, price))
    return rows


def bound_rows(optimum: Optimum) -> list[BoundRow]:
    """A row for each decision: amplitude, period, offset, and the inertia ratio if it is one."""
    best, problem = optimum.best, optimum.problem
    if best is None or optimum.ratio is None:
        return []
    gait = problem.gait
    rows = [
        _bound(name, getattr(best.gait, name), getattr(gait, name), best.bound_prices[name])
        for name in ("amplitude", "period", "offset")
    ]
    if gait.shape != "sine":
        rows[0] = _swing(rows[0], best.bound_prices["amplitude"], best.speed)
    choice = problem.inertia_ratio
    if choice:
        whole = choice.by == "loads" and choice.loads.whole
        price = None if whole else best.bound_prices["ballast"] * _share_per_ratio(problem, choice)
        rows.append(_bound("inertia_ratio", optimum.ratio, choice.bounds, price))
    return rows


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
    """Whether giving way in full would change the speed by more than solvers leave behind."""
    return math.isfinite(limit) and abs(price * limit) > ACTIVE * abs(speed)


def _swing(row: BoundRow, price: float, speed: float) -> BoundRow:
    """The row of the amplitude where the least one bounds the first harmonic and the largest one
    the swing: the price tells which of them holds."""
    if row.side == "fixed":
        return row
    side: Literal["low", "high"] = "high" if price > 0 else "low"
    edge = row.high if price > 0 else row.low
    return replace(row, side=side if _matters(price, edge, speed) else None, price=price)


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


LARGEST_REPLAY_ERROR = 1e-6


@dataclass(frozen=True)
class Check:
    """One check: whether it was passed, and what it found in a sentence."""

    passed: bool
    sentence: str


@dataclass(frozen=True)
class Answer:
    """What `maximize-speed` has to tell.

    name    of the problem
    sha256  fingerprint of its files
    replay, sweep   None where there is no optimum to check
    """

    name: str
    sha256: str
    optimum: Optimum
    replay: Replay | None = None
    sweep: SweepCheck | None = None

    @property
    def checks(self) -> list[Check]:
        """The checks that were made."""
        checks = []
        if self.replay:
            error, excess = self.replay.error, self.replay.excess
            checks.append(
                Check(
                    error <= LARGEST_REPLAY_ERROR,
                    f"Replay by CVODES: its speed is {1e3 * self.replay.speed:+.3f} mm/s, "
                    f"{error:.1e} from the optimiser's, relative "
                    f"(at most {LARGEST_REPLAY_ERROR:.0e} allowed).",
                )
            )
            tail = f"(at most {LARGEST_EXCESS:.0e} allowed)."
            found = (
                f"the worst limit is broken by {excess:.1e} of it {tail}"
                if excess > 0
                else "no limit is broken."
            )
            checks.append(Check(excess <= LARGEST_EXCESS, f"Limits over the whole cycle: {found}"))
        if self.sweep:
            found = _sweep_sentence(self.sweep, self.optimum.problem.gait.shape)
            checks.append(Check(self.sweep.gap >= -TOLERATED, found))
            if not math.isnan(self.sweep.error):
                checks.append(
                    Check(
                        self.sweep.error <= TOLERATED,
                        f"The sweep's own model gives the optimum {1e3 * self.sweep.speed:+.3f} "
                        f"mm/s, {self.sweep.error:.1e} from the optimiser's, relative "
                        f"(at most {TOLERATED:.0e} allowed).",
                    )
                )
        return checks

    @property
    def status(self) -> Status:
        """As the optimiser ended, unless a check failed."""
        if all(check.passed for check in self.checks):
            return self.optimum.status
        return Status.NOT_CONVERGED

    @property
    def headline(self) -> str:
        """What was found, for the head of a page; empty if nothing was confirmed."""
        best = self.optimum.best
        if self.status is not Status.OPTIMAL or best is None:
            return ""
        return (
            f"The fastest gait found drives {direction_text(best.speed)} at "
            f"{1e3 * abs(best.speed):.1f} mm/s"
        )

    @property
    def message(self) -> str:
        """The outcome in a paragraph; a failed check comes first."""
        failed = [check.sentence for check in self.checks if not check.passed]
        if failed:
            return "The optimum was not confirmed. " + " ".join(failed)
        best = self.optimum.best
        if best is None:
            return self.optimum.message
        text = (
            f"The fastest gait found drives {direction_text(best.speed)} at "
            f"{pace_text(best.speed)}, and every check confirms it."
        )
        ties = len(self.optimum.ties)
        if ties:
            text += f" {ties} other gait{'s are' if ties > 1 else ' is'} as fast: a tie."
        sine = self.optimum.sine
        if sine:
            gain = 100 * (abs(best.speed) / sine - 1)
            text += f" That is {gain:.1f} % faster than the fastest sine."
        text += self._servo_note(best.gait)
        if self.sweep and math.isnan(self.sweep.error):
            text += " The sweep's own model could not follow this shape and says nothing of it."
        if self.optimum.sideways:
            text += (
                " It sits where forward turns into backward: its mean velocity is at right angles "
                "to its mean heading, and which way it goes is a matter of definition."
            )
        return text

    def _servo_note(self, gait: Gait) -> str:
        """What the problem's limits allow beyond the servo of the robot file."""
        servo = self.optimum.problem.robot.servo
        beyond = [
            name
            for name, needed, able in (
                ("angle", gait.peak_angle, servo.angle_limit),
                ("rate", gait.peak_rate, servo.rate_limit),
                ("torque", self.replay.reached["torque"] if self.replay else 0, servo.torque_limit),
            )
            if needed > able * (1 + LARGEST_EXCESS)
        ]
        if not beyond:
            return ""
        return (
            f" But the problem allows more than the robot's servo: the gait goes beyond its "
            f"{' and '.join(beyond)} limit."
        )


def _sweep_sentence(sweep: SweepCheck, shape: str) -> str:
    gaits = "gaits" if shape == "sine" else "sines"
    if sweep.best_gait is None:
        return f"Sweep of {sweep.points} {gaits}: none of them keeps every limit."
    head = f"Sweep of {sweep.points} {gaits}: the best has {1e3 * sweep.best_speed:+.3f} mm/s, "
    if abs(sweep.gap) < 1e-6:
        return head + "as fast as the optimum to a millionth."
    if sweep.gap >= 0:
        return head + f"{100 * sweep.gap:.2g} % slower than the optimum."
    return (
        head + f"{-100 * sweep.gap:.2g} % faster than the optimum "
        f"(at most {100 * TOLERATED:g} % allowed)."
    )


def checked(
    name: str,
    sha256: str,
    optimum: Optimum,
    steps: Callable[[str], None],
    swept: SweepResult | None = None,
) -> Answer:
    """The optimum with the evidence for it; swept: of the problem, where that is done."""
    from rr_opt.verify.replay import replay
    from rr_opt.verify.sweep import check_optimum

    best, robot, ratio = optimum.best, optimum.robot, optimum.ratio
    if best is None or robot is None or ratio is None:
        return Answer(name, sha256, optimum)
    steps("replay by CVODES")
    replayed = replay(robot, best.gait, optimum.problem.limits, best.speed)
    steps("check against a sweep")
    check = check_optimum(optimum.problem, best.gait, ratio, best.speed, everywhere=swept)
    return Answer(name, sha256, optimum, replayed, check)
