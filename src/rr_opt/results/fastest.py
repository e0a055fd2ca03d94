"""The fastest gait of a problem, with the evidence for it."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

from rr_opt.design.candidate import StartResult
from rr_opt.design.decisions import ballast_interval, with_ballast
from rr_opt.design.maximize_speed import Optimum
from rr_opt.documents import document as doc
from rr_opt.files.record import plain, robot_record
from rr_opt.formatting import QUANTITIES, counted, direction_text, number, pace_text, with_unit
from rr_opt.messages import listed
from rr_opt.model.ballast import inertia_ratio, load_count
from rr_opt.model.gait import Gait
from rr_opt.model.problem import LARGEST_EXCESS, Problem
from rr_opt.model.robot import Robot
from rr_opt.motion.steady_cycle import Cycle, Energy, energy
from rr_opt.outcome import Status
from rr_opt.results.gait import gait_facts, robot_table, signed_fact, speed_fact
from rr_opt.results.limits import (
    BOUND_NAMES,
    LIMIT_NAMES,
    TOTAL_NAMES,
    BoundRow,
    LimitRow,
    bound_rows,
    bounds_table,
    limit_row,
    limited_by,
    limits_table,
    slippery,
    worst_slack,
)
from rr_opt.results.motion import beyond_servo, trajectory_csv
from rr_opt.results.result import Check, Result, picked
from rr_opt.verify.replay import Replay
from rr_opt.verify.sweep import SweepCheck

if TYPE_CHECKING:
    # Slow to import, and needed by few results.
    from rr_opt.machines.racer.driven import DrivenOptimum
    from rr_opt.results.robust import Robust

LARGEST_REPLAY_ERROR = 1e-6
"""Largest relative error of the replayed speed: the optimiser's mesh is refined well below it."""

LARGEST_COST_ERROR = 1e-4
"""Largest relative error of the cost of transport as objective: it is a sum over samples."""

LARGEST_SLACK = {True: 1e-5, False: 1e-4}
"""Largest violation of complementary slackness, relative to the speed: for sines (True), and for
other shapes, whose limits are held at some phases only."""


@dataclass(frozen=True, repr=False)
class FastestGait(Result):
    """The best gait of a problem, with the evidence for it.

    name, sha256   of the problem: its name, and the fingerprint of its files
    optimum        as the optimiser left it
    replay, sweep  the motion simulated by CVODES, and the comparison with a plain sweep; None
                   where there is no optimum to check
    driven         the gait driven with all effects of the robot, and improved further if the
                   optimiser lacks some; None if the optimum includes them all
    robust         the gait that is fast across the robot's uncertainty; None if not requested
                   or not found
    as_built       speed of the fastest gait of the robot as it is, m/s, if the optimum has another
                   inertia ratio; None otherwise, and if that robot has no such gait
    """

    FILE = "result.json"
    OTHERS = ("trajectory.csv",)
    DRAW = "rr_opt.results.figures.fastest.draw"
    CAPTIONS = doc.captions("fastest")

    name: str
    sha256: str
    optimum: Optimum
    replay: Replay | None = None
    sweep: SweepCheck | None = None
    as_built: float | None = None
    driven: DrivenOptimum | None = None
    robust: Robust | None = None

    @property
    def problem(self) -> Problem:
        """The problem solved."""
        return self.optimum.problem

    @property
    def gait(self) -> Gait | None:
        """The fastest gait, as commanded; None if there is none."""
        if self.driven:
            return self.driven.gait
        return self.command_for(self.optimum.best.gait) if self.optimum.best else None

    @property
    def joint(self) -> Gait | None:
        """The joint motion that results, ignoring backlash; None if there is no gait."""
        if self.gait is None:
            return None
        command = self.problem.command
        return command.servo.response_to(self.gait) if command else self.gait

    def command_for(self, gait: Gait) -> Gait:
        """The command for which the servo makes a joint motion, such as those of `optimum`."""
        command = self.problem.command
        return command.servo.command_for(gait) if command else gait

    @property
    def speed(self) -> float | None:
        """Its mean speed, m/s, negative backward; None if there is no gait."""
        if self.climbed:
            return self.climbed.driven.speed
        return self.optimum.best.speed if self.optimum.best else None

    @property
    def robot(self) -> Robot:
        """The robot, with the optimum's inertia ratio if that was a decision."""
        if self.driven:
            return self.driven.robot
        return self.optimum.robot or self.problem.robot

    @property
    def inertia_ratio(self) -> float | None:
        """J20/J10 of that robot, in the problem's definition; None if there is no gait."""
        return self.driven.ratio if self.driven else self.optimum.ratio

    @property
    def rebuilt(self) -> bool:
        """Whether the optimum's inertia ratio differs from the robot's own."""
        return self.robot.platform2 != self.problem.robot.platform2

    @property
    def climbed(self) -> DrivenOptimum | None:
        """The gait driven with effects that the optimiser lacks; None if it lacks none."""
        return self.driven if self.driven and self.driven.beyond else None

    @property
    def cost(self) -> float | None:
        """Its cost of transport if that is the objective, else None."""
        return self.optimum.best.cost if self.optimum.best else None

    @property
    def cycle(self) -> Cycle | None:
        """The rigid motion of a period; None if there is no gait."""
        if self.climbed:
            return self.climbed.driven.cycle
        return self.replay.steady.cycle if self.replay else None

    @cached_property
    def energy(self) -> Energy | None:
        """Energy of the servo per metre of path: positive work, without recuperation, net work, and
        the cost of transport; None without a gait, and where the motion differs from the
        optimiser's."""
        if self.replay is None or self.climbed:
            return None
        return energy(self.robot, self.replay.steady)

    @property
    def turns(self) -> bool:
        """Whether the robot drives a circle; a radius of many kilometres counts as straight."""
        return self.cycle is not None and abs(self.cycle.dpsi) > 1e-7

    @cached_property
    def limits(self) -> dict[str, LimitRow]:
        """By name (angle, rate, torque, singularity, grip, and any other limits), each with
        `limit`, `value`, `active` and `shadow_price`, SI."""
        reached = self.replay.reached if self.replay else {}
        if self.climbed:
            reached = self.climbed.driven.reached
        names = (*LIMIT_NAMES, *self.problem.limits.economy)
        return {name: limit_row(name, self.optimum, reached) for name in names}

    @cached_property
    def bounds(self) -> dict[str, BoundRow]:
        """The same for amplitude, period, offset, and the inertia ratio if it is a decision; empty
        without a gait."""
        if self.gait is None or self.inertia_ratio is None:
            return {}
        return bound_rows(self.optimum, self.gait, self.inertia_ratio)

    @property
    def active(self) -> list[str]:
        """Names of the limits that constrain the gait."""
        return [row.name for row in self.limits.values() if row.active] if self.replay else []

    def ratio_of(self, candidate: StartResult) -> float:
        """J20/J10 of one of the optima, in the problem's definition."""
        choice = self.problem.inertia_ratio
        span = ballast_interval(self.problem.robot, choice)
        robot = with_ballast(self.problem, span, candidate.share)
        return inertia_ratio(robot, choice.about if choice else "joint")

    @property
    def checks(self) -> list[Check]:
        """Replay by CVODES, the limits over the whole cycle, the sweep, and the gait driven with
        all effects of the robot."""
        return list(self._checks())

    def _checks(self) -> Iterator[Check]:
        replay, sweep = self.replay, self.sweep
        if replay:
            allowed = LARGEST_REPLAY_ERROR * replay.allowance
            speed = f"Replay by CVODES: {1e3 * replay.speed:+.3f} mm/s"
            excess = replay.excess
            worst = (
                f"none is exceeded by more than {excess:.1e} of its value "
                f"(tolerance {LARGEST_EXCESS:.0e})."
                if excess > 0
                else "none is exceeded."
            )
            yield _within(speed, replay.error, allowed)
            yield Check(excess <= LARGEST_EXCESS, f"Limits over the whole cycle: {worst}")
            if self.optimum.best:
                name, share = worst_slack(self.optimum, self.optimum.best.gait, replay.reached)
                most = LARGEST_SLACK[self.problem.gait.shape == "sine"]
                aim = "cost of transport" if self.cost else "speed"
                slackness = (
                    f"Complementary slackness: the price of the {name} times its slack is "
                    f"{share:.1e} of the {aim} (tolerance {most:.0e})."
                )
                yield Check(share <= most, slackness)
        if self.cost and self.energy:
            yield self._cost_within("of the replay", self.energy.cost_of_transport)
        if sweep:
            better = _sweep_sentence(sweep, self.problem.gait.shape, self.cost)
            yield Check(sweep.better is None, better)
            if not math.isnan(sweep.error):
                own = f"The sweep's own model of the optimum: {1e3 * sweep.speed:+.3f} mm/s"
                yield _within(own, sweep.error, sweep.largest_error)
            if self.cost:
                yield self._cost_within("by the sweep's own model", sweep.cost)
        if self.robust:
            yield self.robust.check
        if self.driven and self.optimum.best:
            yield _driven_check(self.driven, self.optimum, self.optimum.best.speed)

    def _cost_within(self, whose: str, cost: float) -> Check:
        error = abs(cost / (self.cost or math.nan) - 1)
        return _within(f"Cost of transport {whose}: {number(cost)}", error, LARGEST_COST_ERROR)

    @property
    def status(self) -> Status:
        """The optimiser's status, unless a check failed."""
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
        if self.speed is None:
            return self.optimum.message
        first = f"{self._subject} at {pace_text(self.speed)}"
        first += "." if self.climbed else ", and every check confirms it."
        return " ".join([first, *self.remarks])

    @property
    def _subject(self) -> str:
        return f"{self._found('gait')} drives {direction_text(self.speed or 0.0)}"

    def _found(self, what: str) -> str:
        if self.cost:
            return f"The {what} with the lowest cost of transport found, {number(self.cost)},"
        return f"The fastest {what} found"

    @property
    def remarks(self) -> list[str]:
        """Further remarks on the gait, in sentences."""
        best = self.optimum.best
        if best is None:
            return []
        texts = list(slippery(self.limits["grip"].value))
        if self.problem.robust:
            robust = self.robust
            texts.append(robust.sentence(best.speed) if robust else "No robust gait was found.")
        if self.climbed:
            texts.append(_climbed(self.climbed, self.optimum))
        if self.driven and self.driven.driven.left_out:
            names = listed(self.driven.driven.left_out)
            texts.append(f"It is valid away from {names}, which no steady motion can include.")
        ties = len(self.optimum.ties)
        if ties:
            texts.append(f"{ties} other gait{'s are' if ties > 1 else ' is'} just as fast: a tie.")
        sine = self.optimum.sine
        if sine:
            gain = 100 * (abs(best.speed) / sine - 1)
            texts.append(f"That is {gain:.1f} % faster than the fastest sine.")
        gait, servo = best.gait, self.problem.robot.servo
        torque = self.replay.reached["torque"] if self.replay else 0.0
        if beyond := beyond_servo(servo, gait.peak_angle, gait.peak_rate, torque):
            texts.append(
                "But the problem allows more than the robot's servo does: the gait exceeds its "
                f"{listed(name for name, *_ in beyond)} limit."
            )
        if self.sweep and math.isnan(self.sweep.error):
            texts.append("The sweep's own model cannot represent this shape and does not check it.")
        if self.optimum.sideways:
            texts.append(
                "It lies where forward motion turns into backward motion: its mean velocity is "
                "perpendicular to its mean heading, so its direction is a matter of definition."
            )
        return texts

    @property
    def warnings(self) -> tuple[str, ...]:
        """What the robot does with effects that the optimiser lacks, and grip that wheels may not
        have."""
        climbed = (_climbed(self.climbed, self.optimum),) if self.climbed else ()
        return (*climbed, *slippery(self.limits["grip"].value))

    def _record(self) -> dict[str, Any]:
        """The content of result.json; its keys do not depend on the outcome."""
        optimum, replay, sweep = self.optimum, self.replay, self.sweep
        cycle, driven = self.cycle, self.driven
        return {
            **picked(self, "status message warnings gait joint inertia_ratio speed energy"),
            "problem": self.name,
            "objective": self.problem.objective,
            "speed_as_built": self.as_built,
            "cycle": cycle
            and {**picked(cycle, "dx dy dpsi"), "radius": cycle.radius if self.turns else None},
            "limits": [
                {**plain(row), "unit": UNITS[row.name], "active": row.active if replay else None}
                for row in self.limits.values()
            ],
            "grip": replay and {"axle1": replay.grip[0], "axle2": replay.grip[1]},
            "bounds": list(self.bounds.values()),
            "check": replay
            and sweep
            and {
                "sweep_points": sweep.points,
                "sweep_best": sweep.best and sweep.best.speed,
                "sweep_gait": sweep.best and sweep.best.gait,
                "gap": sweep.gap,
                "climb_gain": sweep.gained,
                "sweep_error": sweep.error,
                "replay_error": replay.error,
                "replay_speed": replay.speed,
                "limit_excess": replay.excess,
            },
            "robust": self.robust and self.robust.record(),
            "driven": driven
            and {
                **picked(driven.driven, "effects left_out speeds"),
                "beyond_optimiser": driven.beyond,
                "speed_without": optimum.best and optimum.best.speed,
            },
            "solver": {
                **picked(optimum, "starts iterations intervals failures"),
                "distinct_optima": [
                    {
                        "speed": one.speed,
                        "gait": self.command_for(one.gait),
                        "inertia_ratio": self.ratio_of(one),
                    }
                    for one in optimum.optima
                ],
                "ties": len(optimum.ties),
            },
            "robot": robot_record(self.robot),
            "loads": _loads(self),
            "units": UNITS,
        }

    def document(self, figures: Sequence[doc.Figure] = ()) -> doc.Document:
        """The report of a fastest gait."""
        choice, solved = self.problem.inertia_ratio, self.gait is not None
        chosen = "platform2.I" if choice and choice.by == "inertia" and solved else ""
        objective, failure = self.problem.objective, _TITLES[self.status]
        limits, bounds = self.limits.values(), self.bounds.values()
        lead = " ".join(
            [
                *([] if self.climbed else ["Every check confirms it."]),
                *self.remarks,
                limited_by(limits, bounds) if self.replay else "",
            ]
        )
        return self._outcome(
            "fastest gait",
            self.headline or failure,
            failure,
            doc.section("", doc.facts(_facts(self), key=True)),
            self._lead(),
            self.robust.section() if self.robust else doc.section(""),
            doc.section("Checks", doc.checks(self.checks)),
            doc.gallery(figures),
            doc.section("Limits", limits_table(limits, solved, objective), brief=solved),
            doc.section("Decisions and their bounds", bounds_table(bounds, objective)),
            doc.section("Local optima", _optima(self)),
            doc.section("Robot", robot_table(self.robot, chosen), brief=False),
            doc.section("Solver", _solver(self), brief=solved),
            lead=lead,
        )

    def _lead(self) -> doc.Section:
        """The content before the checks."""
        return doc.section("")

    def _tables(self) -> dict[str, str]:
        replay = self.replay
        return {"trajectory.csv": trajectory_csv(replay.steady)} if replay else {}


def _within(what: str, error: float, allowed: float) -> Check:
    return Check(error <= allowed, f"{what}, relative error {error:.1e} (tolerance {allowed:.0e}).")


LARGEST_DRIVEN_ERROR = 0.01
"""Largest relative difference of the speed with all effects from the optimiser's, if that has them
too or the gait was not improved further."""


def _driven_check(found: DrivenOptimum, optimum: Optimum, speed: float) -> Check:
    """The commanded gait, driven by the simulation that predicts recordings."""
    seen, names = found.driven, listed(found.driven.effects)
    if found.beyond and optimum.problem.gait.shape == "sine" and not optimum.problem.turn:
        worst, excess = optimum.problem.limits.worst(seen.reached)
        return Check(
            excess <= LARGEST_EXCESS,
            f"Driven with {names}: the tightest limit is that on {worst}, exceeded by "
            f"{max(excess, 0.0):.1e} of its value (tolerance {LARGEST_EXCESS:.0e}).",
        )
    own = f"Driven with {names}, the gait above as the command: {1e3 * seen.speed:+.3f} mm/s"
    return _within(own, seen.error(speed), LARGEST_DRIVEN_ERROR)


def _climbed(found: DrivenOptimum, optimum: Optimum) -> str:
    """How the effects that the optimiser lacks change the optimum."""
    names, speed = listed(found.beyond), found.driven.speed
    without = optimum.best.speed if optimum.best else math.nan
    change, gain = speed / without - 1, abs(speed / found.start.speed) - 1
    text = (
        f"The optimiser does not model {names}. Its own optimum is {1e3 * without:+.2f} mm/s, "
        f"which every check confirms; with all effects the speed changes by {100 * change:+.2g} %, "
        f"including the {100 * gain:.2g} % gained by a local search. The gait is a local optimum; "
        "no sweep checks it."
    )
    if len(found.driven.speeds) > 1:
        low, high = (1e3 * end(found.driven.speeds) for end in (min, max))
        text += f" The speed is a mean over headings, {low:+.2f} to {high:+.2f} mm/s."
    return text


def _sweep_sentence(sweep: SweepCheck, shape: str, cost: float | None) -> str:
    gaits, best = "gaits" if shape == "sine" else "sines", sweep.best
    if best is None:
        return f"Sweep of {sweep.points} {gaits}: none respects every limit."
    head = f"Sweep of {sweep.points} {gaits}, climbing from the best of them and from the optimum: "
    at, worse, better = f"{1e3 * best.speed:+.3f} mm/s", "slower", "faster"
    if cost:
        at, worse, better = f"a cost of transport of {number(1 / best.merit)}", "higher", "lower"
    head += f"it reaches {at}, "
    if abs(sweep.gap) < sweep.tolerated:
        return head + f"equal to the optimum to within {sweep.tolerated:.0e}."
    if sweep.gap >= 0:
        return head + f"{100 * sweep.gap:.2g} % {worse} than the optimum."
    return (
        head + f"{-100 * sweep.gap:.2g} % {better} than the optimum "
        f"(tolerance {100 * sweep.tolerated:g} %)."
    )


_TITLES = {
    Status.OPTIMAL: "The robot does not move",
    Status.INFEASIBLE: "No gait respects all limits",
    Status.NOT_CONVERGED: "No confirmed optimum",
}


def _facts(result: FastestGait) -> Iterator[doc.Fact]:
    if result.speed is None or result.gait is None or result.cycle is None:
        return
    yield speed_fact(result.speed)
    if result.rebuilt and result.as_built is not None:
        yield signed_fact("as built", result.as_built, "at best, with I2 unchanged")
    yield from gait_facts(result.gait)
    yield _ratio(result)
    yield _cycle(result.cycle, turning=result.turns)
    if result.energy:
        gross, net = (with_unit(one, "J/m") for one in (result.energy.gross, result.energy.net))
        cost = number(result.energy.cost_of_transport)
        yield doc.Fact("energy", gross, f"positive work of the servo, net {net}")
        yield doc.Fact("", cost, "cost of transport: that over the weight")


def _ratio(result: FastestGait) -> doc.Fact:
    """J20/J10, about which point, and how it is realised."""
    choice, built = result.problem.inertia_ratio, result.problem.robot
    about = choice.about if choice else "joint"
    ratio = number(result.inertia_ratio or 0.0)
    detail = f"about {'the joint P' if about == 'joint' else 'the centres of mass'}"
    if choice is None or not result.rebuilt:
        return doc.Fact("J20/J10", ratio, f"{detail}, the robot as it is")
    detail += ", by loads on platform 2" if choice.by == "loads" else ""
    detail += f": I2 {built.platform2.I:.4g} -> {result.robot.platform2.I:.4g} kg m2 "
    detail += f"(ratio {number(inertia_ratio(built, about))} -> {ratio})"
    return doc.Fact("J20/J10", ratio, detail)


def _cycle(cycle: Cycle, *, turning: bool) -> doc.Fact:
    step, way = f"{1e3 * math.hypot(cycle.dx, cycle.dy):.1f} mm a period", "straight"
    if turning:
        way = f"round a circle of radius {with_unit(cycle.radius, 'm')}, "
        way += f"turning {math.degrees(cycle.dpsi):+.3g} deg a period"
    return doc.Fact("cycle", step, way)


def _optima(result: FastestGait) -> doc.Table:
    """All local optima; nothing if there is only one."""
    optimum = result.optimum
    ties = {id(one) for one in optimum.ties}
    rows = [
        [
            f"{1e3 * one.speed:+.2f} mm/s",
            with_unit(command.amplitude, "rad"),
            with_unit(command.period, "s"),
            with_unit(command.offset, "rad"),
            number(result.ratio_of(one)),
            "the optimum" if one is optimum.best else "a tie" if id(one) in ties else "",
        ]
        for one, command in ((one, result.command_for(one.gait)) for one in optimum.optima)
    ]
    head = ["Speed", "Amplitude", "Period", "Offset", "J20/J10", "Remark"]
    return doc.table(head, rows if len(rows) > 1 else [])


def _solver(result: FastestGait) -> str:
    optimum, guesses = result.optimum, ("initial guess", "initial guesses")
    text = (
        f"{counted(optimum.starts, *guesses)}, {counted(optimum.iterations, 'iteration')}, "
        f"{optimum.intervals} intervals a period, "
        f"{counted(len(optimum.optima), 'distinct optimum', 'distinct optima')}."
    )
    failed = len(optimum.failures)
    return f"{text} {counted(failed, *guesses)} led to no optimum." if failed else text


UNITS = {
    **{name: QUANTITIES[name].unit or "1" for name in (*LIMIT_NAMES, *BOUND_NAMES, *TOTAL_NAMES)},
    "grip": "1, largest side force of an axle over the load on it",
    "power": "W, mean positive power of the servo",
    "speed_as_built": "m/s, of the fastest gait of the robot with its inertia ratio unchanged",
    "dx": "m",
    "dy": "m",
    "dpsi": "rad",
    "radius": "m",
    "energy": "J per metre of path: gross, the positive work of the servo, none of it recovered; "
    "net, what friction takes; cost_of_transport, gross over the weight, 1; power, gross per "
    "second, W",
    "shadow_price": "m/s of |speed| per SI unit by which the limit or bound is raised; with the "
    "objective cost_of_transport how much that falls",
    "gap": "(|speed| - |sweep_best|)/|speed|; with the objective cost_of_transport of its inverse",
    "climb_gain": "gain in |speed|, or in the inverse of the cost of transport, relative, of a "
    "climb by SLSQP on the sweep's model from the optimum",
    "sweep_error": "|speed by the sweep's model - speed|/|speed|",
    "replay_error": "|replay speed - speed|/|speed|",
    "limit_excess": "largest (value - limit)/limit over the replayed cycle",
}


def _loads(result: FastestGait) -> float | None:
    """How many loads the robot carries, where loads realise the inertia ratio."""
    choice, ratio = result.problem.inertia_ratio, result.inertia_ratio
    if choice is None or choice.by != "loads" or ratio is None:
        return None
    count = load_count(result.problem.robot, ratio, choice.about, choice.loads)
    return round(count) if choice.loads.whole else count
