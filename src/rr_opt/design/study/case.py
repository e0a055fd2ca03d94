"""A study: one problem solved for many values of its keys, warm-started from neighbouring optima;
and the quantities of each optimum: distance travelled, active limits, energy."""

import math
import time
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

from rr_opt.design.candidate import StartResult, distinct
from rr_opt.design.decisions import Setting, decisions, robot_of, settings_of, share_per_ratio
from rr_opt.design.families import SIGNS, refine, solve_from
from rr_opt.design.maximize_speed import maximize_speed
from rr_opt.design.study.plan import Foothold, Plan, expected_speed, footholds
from rr_opt.design.study.row import CaseOptimum, Row, gait_record
from rr_opt.model.ballast import inertia_ratio
from rr_opt.model.problem import LARGEST_EXCESS, LEAST, Interval, Problem
from rr_opt.model.robot import Robot
from rr_opt.motion.servo import for_joint
from rr_opt.motion.steady_cycle import SteadyCycle, energy, grip_needed, peak_torque, steady_cycle
from rr_opt.outcome import NotConvergedError, RollerRacerError, Status

_SURPRISE = 0.01
"""A speed outside the expected range by more than this, relative, is checked by cold starts."""
_SAME_SPEED = 1e-6


@dataclass(frozen=True)
class Task:
    """A case to solve; cold starts if it has no footholds.

    expected  range of |speed| predicted from the neighbours, m/s
    """

    problem: Problem
    footholds: tuple[Foothold, ...] = ()
    expected: tuple[float, float] | None = None


def solve_case(task: Task) -> Row:
    """Solve a case. Any failure is reported as a row."""
    begun = time.process_time()
    try:
        row = _solve(replace(task, problem=for_joint(task.problem)))
    except RollerRacerError as error:
        row = Row(Status.NOT_CONVERGED, str(error))
    except Exception as error:  # one failing case must not end a study of a thousand
        what = f"{type(error).__name__}: {error}"
        row = Row(Status.NOT_CONVERGED, f"The case failed with an internal error: {what}.")
    return replace(row, seconds=time.process_time() - begun)


def _solve(task: Task) -> Row:
    # Neighbours predict speeds, not costs.
    warm = task.footholds and task.problem.objective == "speed"
    setting = _only_setting(task.problem) if warm else None
    if setting is None:
        return _cold(task.problem)
    reached: list[tuple[Foothold, StartResult]] = []
    for foothold in task.footholds:
        candidate = _continued(setting, foothold)
        if candidate is not None:
            reached.append((foothold, candidate))
    best = _best(setting, [candidate for _, candidate in reached])
    row = _warm(setting, best) if best else None
    if row is None or _doubtful(task, row, [candidate for _, candidate in reached]):
        cold = _cold(task.problem)
        row = replace(_faster(row, cold), started="warm and cold")
    return replace(
        row,
        tried=_cases(task.footholds),
        continued=_cases(foothold for foothold, candidate in reached if _is(candidate, row)),
        expected=task.expected,
    )


def _cases(footholds: Iterable[Foothold]) -> tuple[int, ...]:
    return tuple(case for one in footholds for case in one.cases)


def _only_setting(problem: Problem) -> Setting | None:
    """The problem made ready; None where the interior is empty, or where whole numbers of loads
    split it into several problems."""
    box = decisions(problem)
    if box.empty or box.amplitude_pinned:
        return None
    settings = settings_of(problem, box)
    return settings[0] if len(settings) == 1 else None


def _continued(setting: Setting, foothold: Foothold) -> StartResult | None:
    """The optimum warm-started from a neighbour's; None if the solve fails."""
    wanted, shape = SIGNS[setting.problem.direction], setting.problem.gait.shape
    if foothold.sign not in wanted or foothold.gait.shape != shape:
        return None
    try:
        found = solve_from(setting, foothold.sign, foothold.gait, foothold.share)
    except NotConvergedError:
        return None
    return found if found.feasible and found.success else None


def _best(setting: Setting, candidates: list[StartResult]) -> StartResult | None:
    """The fastest candidate, each optimum refined once."""
    ranked = [(setting, one) for one in sorted(candidates, key=lambda one: one.rank)]
    refined = [refine(setting, one) for _, one in distinct(ranked)]
    good = [one for one in refined if one.feasible and one.success]
    return min(good, key=lambda one: one.rank, default=None)


def _doubtful(task: Task, row: Row, reached: list[StartResult]) -> bool:
    """Whether neighbours disagree, or predict a speed other than the one found."""
    if task.expected is None or len(reached) < len(task.footholds) or row.optimum is None:
        return True
    least, most = task.expected
    as_expected = least * (1 - _SURPRISE) <= abs(row.optimum.speed) <= most * (1 + _SURPRISE)
    return not as_expected or not all(_is(one, row) for one in reached)


def _is(candidate: StartResult, row: Row) -> bool:
    """Whether an unrefined candidate is the optimum of a row; mirror images count as the same."""
    one, other = candidate.gait, row.optimum
    return other is not None and (
        candidate.sign == other.sign
        and math.isclose(candidate.speed, other.speed, rel_tol=1e-3)
        and math.isclose(one.amplitude, other.amplitude, rel_tol=1e-2)
        and math.isclose(one.period, other.period, rel_tol=1e-2)
        and math.isclose(abs(one.offset), abs(other.offset), abs_tol=1e-2)
    )


def _faster(warm: Row | None, cold: Row) -> Row:
    """The faster row; the cold one on a tie."""
    if warm is None or warm.optimum is None:
        return cold
    if cold.optimum is None:
        return warm
    least = abs(warm.optimum.speed) * (1 - _SAME_SPEED)
    return cold if abs(cold.optimum.speed) >= least else warm


def _cold(problem: Problem) -> Row:
    solved = maximize_speed(problem)
    if solved.best is None or solved.robot is None or solved.ratio is None:
        return Row(solved.status, solved.message, iterations=solved.iterations)
    row = measured(problem, solved.best, solved.robot, solved.ratio)
    return replace(row, iterations=solved.iterations)


def _warm(setting: Setting, best: StartResult) -> Row:
    robot, choice = robot_of(setting, best.share), setting.problem.inertia_ratio
    ratio = inertia_ratio(robot, choice.about if choice else "joint")
    return replace(measured(setting.problem, best, robot, ratio), started="warm")


Solve = Callable[[Mapping[int, Task]], Iterator[tuple[int, Row | str]]]
"""Solves tasks in any order, on one process or many, and yields each case's row when it is found,
or a sentence if its process was lost."""


def solve_study(
    problems: Sequence[Problem],
    planned: Plan,
    known: Mapping[int, Row],
    solve: Solve,
    *,
    cold: bool = False,
) -> Iterator[tuple[int, Row]]:
    """The rows of all cases not yet known, as they are found.

    cold: use no warm starts. Rows do not depend on the order of work.
    """
    rows = dict(known)

    def found(tasks: Mapping[int, Task]) -> Iterator[tuple[int, Row]]:
        for case, outcome in solve(tasks):
            lost = isinstance(outcome, str)
            rows[case] = Row(Status.NOT_CONVERGED, outcome) if lost else outcome
            yield case, rows[case]

    first = range(len(problems)) if cold else planned.anchors
    yield from found({case: Task(portable(problems[case])) for case in first if case not in rows})
    if cold:
        return
    left = {case: donors for case, donors in planned.donors.items() if case not in rows}
    yield from found(
        {
            case: Task(
                portable(problems[case]),
                tuple(footholds(donors, rows)),
                expected_speed(problems[case], donors, rows, problems),
            )
            for case, donors in left.items()
        }
    )


def portable(problem: Problem) -> Problem:
    """A problem that can be sent to another process, stripped of what is not needed there."""
    physics = tuple(replace(use, values=dict(use.values)) for use in problem.robot.physics)
    return replace(problem, robot=replace(problem.robot, provenance={}, physics=physics))


UNITS = {
    **{"angle": "rad", "rate": "rad/s", "torque": "N m", "singularity": "m", "grip": ""},
    **{"power": "W", "cost_of_transport": "", "speed": "m/s"},
}
"""The quantity of each limit, by the limit's name in the problem."""


def reached(robot: Robot, steady: SteadyCycle) -> dict[str, float]:
    """The extreme of each limited quantity, SI: largest |phi|, |dphi/dt|, |torque|, least S1,
    largest side force over load, power, cost of transport and speed."""
    gait, work = steady.gait, energy(robot, steady)
    return {
        "angle": gait.peak_angle,
        "rate": gait.peak_rate,
        "torque": peak_torque(steady),
        "singularity": float(robot.S1(gait.peak_angle)),
        "grip": max(grip_needed(steady, robot)),
        "power": work.power,
        "cost_of_transport": work.cost_of_transport,
        "speed": abs(steady.speed),
    }


_ON = 1e-4
"""A limit is active for a sine within this distance of it, relative to the limit."""
_PRICED = 1e-4
"""A limit is active for a gait of another shape if, at its shadow price, raising the limit by its
own size would gain more than this, relative to the speed."""


@dataclass(frozen=True)
class Held:
    """Names of the active limits and bounds, and |speed| gained per unit of each."""

    names: tuple[str, ...]
    prices: Mapping[str, float]
    bound_prices: Mapping[str, float]


def held(problem: Problem, best: StartResult, reached: Mapping[str, float], ratio: float) -> Held:
    """The active constraints of a candidate; reached: extremes of the limited quantities."""
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
    """A sine reaches its active limits. With another shape the angle stays slightly short of its
    limit, and so may the torque: there the shadow price decides."""
    limit = getattr(problem.limits, name)
    if not limit or not math.isfinite(limit):
        return False
    if problem.gait.shape != "sine":
        return _matters(best, best.prices[name], limit)
    slack = value - limit if name in LEAST else limit - value
    return slack <= _ON * abs(limit)


def _matters(best: StartResult, price: float, size: float) -> bool:
    """Whether a price, for a limit or bound of this size, exceeds the solver's residual."""
    return abs(price) * abs(size) > _PRICED * abs(best.speed)


def _bounds(
    problem: Problem, best: StartResult, ratio: float
) -> Iterator[tuple[str, str, float | None]]:
    places = [
        (name, getattr(best.gait, name), getattr(problem.gait, name), best.bound_prices.get(name))
        for name in ("amplitude", "period", "offset")
    ]
    choice = problem.inertia_ratio
    if choice and not choice.bounds.fixed:
        price = best.bound_prices["ballast"] * share_per_ratio(problem.robot, choice)
        whole = choice.by == "loads" and choice.loads.whole
        places.append(("inertia_ratio", ratio, choice.bounds, None if whole else price))
    for name, value, box, price in places:
        if side := _side(problem, best, value, box, price):
            yield name, side, price


def _side(
    problem: Problem, best: StartResult, value: float, box: Interval, price: float | None
) -> str | None:
    """`least` or `largest` if the value is at that end of a range that leaves a choice."""
    size = max(abs(box.low), abs(box.high))
    if box.fixed:
        return None
    if problem.gait.shape != "sine" and price is not None:
        at_end = "largest" if price > 0 else "least"
        return at_end if _matters(best, price, size) else None
    near = _ON * min(box.high - box.low, size)
    return "least" if value - box.low <= near else "largest" if box.high - value <= near else None


_CLAIM = 1e-6
"""Largest relative difference between the claimed speed and that of the steady cycle."""
_STRAIGHT = 1e-7
"""Heading gained per period below which the robot goes straight, rad."""
_SIDEWAYS = 1e-3


def measured(problem: Problem, best: StartResult, robot: Robot, ratio: float) -> Row:
    """The row of an optimum of a problem, with its robot and J20/J10.

    NOT_CONVERGED if the steady cycle differs in speed from the optimiser's claim, or violates a
    limit. Raises NotConvergedError if the gait has no steady cycle.
    """
    gait, steady = best.gait, steady_cycle(robot, best.gait)
    error = abs(steady.speed / best.speed - 1)
    if not error <= _CLAIM:
        message = (
            f"The optimiser claims {best.speed:.6g} m/s but the steady cycle has "
            f"{steady.speed:.6g} m/s, a relative error of {error:.1e} (at most {_CLAIM:.0e} "
            "allowed). Solve the case alone with `rr-opt maximize-speed`."
        )
        return Row(Status.NOT_CONVERGED, message)
    extremes = reached(robot, steady)
    name, excess = problem.limits.worst(extremes)
    if not excess <= LARGEST_EXCESS:
        unit, limit = UNITS[name], getattr(problem.limits, name)
        message = (
            f"The optimiser's gait reaches {extremes[name]:.6g} {unit}. Expected it to keep the "
            f"limit on {name}, {limit:.6g} {unit}, which it exceeds by {excess:.1e} of it (at most "
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
