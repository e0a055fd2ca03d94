"""An optimum, measured: how far it goes, what holds it, what it costs."""

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from rr_opt.design.candidate import StartResult
from rr_opt.design.decisions import share_per_ratio
from rr_opt.design.study.row import CaseOptimum, Row, gait_record
from rr_opt.model.problem import LARGEST_EXCESS, LEAST, Interval, Problem
from rr_opt.model.robot import Robot
from rr_opt.motion.energy import energy
from rr_opt.motion.steady_cycle import SteadyCycle, grip_needed, peak_torque, steady_cycle
from rr_opt.outcome import Status

UNITS = {
    **{"angle": "rad", "rate": "rad/s", "torque": "N m", "singularity": "m", "grip": ""},
    **{"power": "W", "cost_of_transport": "", "speed": "m/s"},
}
"""Of each limit, by its name in the problem."""


def reached(robot: Robot, steady: SteadyCycle) -> dict[str, float]:
    """The extreme of what each limit bounds, SI: largest |phi|, |dphi/dt|, |torque|, least S1,
    largest side force over load, power, cost of transport and speed."""
    gait, work = steady.gait, energy(robot, steady)
    return {
        "angle": gait.peak_angle,
        "rate": gait.peak_rate,
        "torque": peak_torque(steady),
        "singularity": robot.platform1.c * math.cos(gait.peak_angle) + robot.platform2.c,
        "grip": max(grip_needed(steady, robot)),
        "power": work.power,
        "cost_of_transport": work.cost_of_transport,
        "speed": abs(steady.speed),
    }


_ON = 1e-4
"""A limit holds a sine that comes this near to it, relative to the limit."""
_PRICED = 1e-4
"""A limit holds a gait of another shape if raising it by all of itself would, at its price, gain
more than this, relative to the speed."""


@dataclass(frozen=True)
class Held:
    """Names of what holds an optimum, and |speed| gained per unit by which each is raised."""

    names: tuple[str, ...]
    prices: Mapping[str, float]
    bound_prices: Mapping[str, float]


def held(problem: Problem, best: StartResult, reached: Mapping[str, float], ratio: float) -> Held:
    """What holds a candidate; reached: the extremes of what the limits bound."""
    prices = {
        name: best.prices[name]
        for name, value in reached.items()
        if _on_limit(problem, best, name, value)
    }
    prices |= {
        name: price
        for name, price in best.prices.items()
        if name in ("curvature", "yaw_rate", "heading") and abs(price) > 1e-9
    }
    names, bound_prices = list(prices), {}
    for name, side, price in _bounds(problem, best, ratio):
        names.append(f"{side} {name}")
        if price is not None:
            bound_prices[name] = price
    return Held(tuple(names), prices, bound_prices)


def _on_limit(problem: Problem, best: StartResult, name: str, value: float) -> bool:
    """A sine that is held by a limit comes to it. Of another shape the angle stays a little short
    of its limit, and so may the torque: there the price says it."""
    limit = getattr(problem.limits, name)
    if not limit or not math.isfinite(limit):
        return False
    if problem.gait.shape != "sine":
        return _matters(best, best.prices[name], limit)
    slack = value - limit if name in LEAST else limit - value
    return slack <= _ON * abs(limit)


def _matters(best: StartResult, price: float, size: float) -> bool:
    """Whether a limit or bound of this size has a price that is no zero left by the solver."""
    return abs(price) * abs(size) > _PRICED * abs(best.speed)


def _bounds(
    problem: Problem, best: StartResult, ratio: float
) -> Iterator[tuple[str, str, float | None]]:
    gait = problem.gait
    ranges = {"amplitude": gait.amplitude, "period": gait.period, "offset": gait.offset}
    for name, box in ranges.items():
        price = best.bound_prices.get(name)
        side = _side(problem, best, getattr(best.gait, name), box, price)
        if side:
            yield name, side, price
    choice = problem.inertia_ratio
    if choice is None or choice.bounds.fixed:
        return
    whole = choice.by == "loads" and choice.loads.whole
    price = None if whole else best.bound_prices["ballast"] * share_per_ratio(problem.robot, choice)
    side = _side(problem, best, ratio, choice.bounds, price)
    if side:
        yield "inertia_ratio", side, price


def _side(
    problem: Problem, best: StartResult, value: float, box: Interval, price: float | None
) -> str | None:
    """`least` or `largest` if a range that leaves a choice holds the value at that end."""
    size = max(abs(box.low), abs(box.high))
    if box.fixed:
        return None
    if problem.gait.shape != "sine" and price is not None:
        at_end = "largest" if price > 0 else "least"
        return at_end if _matters(best, price, size) else None
    near = _ON * min(box.high - box.low, size)
    return "least" if value - box.low <= near else "largest" if box.high - value <= near else None


_CLAIM = 1e-6
"""Largest difference of a claimed speed from that of the steady cycle, relative."""
_STRAIGHT = 1e-7
"""Heading gained per period below which the robot goes straight, rad."""
_SIDEWAYS = 1e-3


def measured(problem: Problem, best: StartResult, robot: Robot, ratio: float) -> Row:
    """The row of an optimum of a problem, with the robot and the J20/J10 that it chose.

    NOT_CONVERGED if the steady cycle has another speed than the optimiser claims, or breaks a
    limit. Raises NotConvergedError if the gait has no steady cycle.
    """
    gait, steady = best.gait, steady_cycle(robot, best.gait)
    error = abs(steady.speed / best.speed - 1)
    if not error <= _CLAIM:
        message = (
            f"The optimiser claims {best.speed:.6g} m/s and the steady cycle has "
            f"{steady.speed:.6g} m/s, {error:.1e} from it (at most {_CLAIM:.0e} allowed). "
            "Solve the case alone with `rr-opt maximize-speed`."
        )
        return Row(Status.NOT_CONVERGED, message)
    extremes = reached(robot, steady)
    name, excess = problem.limits.worst(extremes)
    if not excess <= LARGEST_EXCESS:
        unit, limit = UNITS[name], getattr(problem.limits, name)
        message = (
            f"The optimiser's gait reaches {extremes[name]:.6g} {unit}. Expected it to keep the "
            f"limit on {name}, {limit:.6g} {unit}, which it breaks by {excess:.1e} of it (at most "
            f"{LARGEST_EXCESS:.0e} allowed). Solve the case alone with `rr-opt maximize-speed`."
        )
        return Row(Status.NOT_CONVERGED, message)
    work, turn = energy(robot, steady), steady.cycle.dpsi
    on = held(problem, best, extremes, ratio)
    optimum = CaseOptimum(
        gait=gait_record(gait),
        sign=best.sign,
        share=best.share,
        speed=best.speed,
        amplitude=gait.amplitude,
        period=gait.period,
        offset=gait.offset,
        ratio=ratio,
        cycle_length=abs(best.speed) * gait.period,
        turn=turn,
        radius=abs(best.speed) * gait.period / abs(turn) if abs(turn) > _STRAIGHT else None,
        peak_angle=extremes["angle"],
        peak_rate=extremes["rate"],
        peak_torque=extremes["torque"],
        least_s1=extremes["singularity"],
        peak_grip=extremes["grip"],
        energy_per_metre=work.gross,
        net_energy_per_metre=work.net,
        cost_of_transport=work.cost_of_transport,
        held=on.names,
        prices=on.prices,
        bound_prices=on.bound_prices,
        sideways=abs(best.prices["direction"]) > _SIDEWAYS,
    )
    return Row(Status.OPTIMAL, best.sentence, optimum, iterations=best.iterations)
