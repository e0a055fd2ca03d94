"""The fastest gait, as commanded, of a robot driven with all its effects.

It uses the simulation that predicts recordings, so that servo, contact and floor are as diagnosed.
Periods are simulated until the speed repeats. On a tilted floor the speed depends on the heading:
the heading is held fixed, as one period is short, and all headings are tried. On a floor that
differs from place to place no motion is steady; that effect is left out.

The multiple-shooting optimiser does not model play, slip or tilt. From its optima a simplex search
climbs on the speed of this simulation.
"""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace

import casadi as ca
import numpy as np

from rr_opt.array import Array
from rr_opt.design.decisions import decisions, robot_of, settings_of
from rr_opt.design.maximize_speed import Optimum
from rr_opt.effects import CATALOGUE
from rr_opt.effects.effect import Port
from rr_opt.machines.racer.drive import drive_path, grain, steps_of
from rr_opt.machines.racer.parameters import effect_values
from rr_opt.machines.racer.simulation import V, driven
from rr_opt.model.ballast import inertia_ratio
from rr_opt.model.gait import Gait, SineGait
from rr_opt.model.problem import LARGEST_EXCESS
from rr_opt.model.robot import Robot
from rr_opt.motion.dynamics import dynamics_of, steady_effects, values_of
from rr_opt.motion.floor_motion import FloorMotion, floor_motion
from rr_opt.motion.servo import linear_servo, servo_drive
from rr_opt.motion.steady_cycle import Cycle, cycle_of
from rr_opt.outcome import NotConvergedError
from rr_opt.sysid.paths import DrivePath
from rr_opt.sysid.shooting import System, predict

_SAMPLES = 256
"""Samples per period, with at least one step between two."""
_HEADINGS = 8
_ROUNDS, _REPEATS = 500, 1e-7
"""Most periods, and the relative change of v over one that counts as none."""
_FIRST, _NEARER = 0.05, 0.9
"""m/s, the first step of the secant search for v; and the share of the gap that a step may leave,
for the next one to take the slope between the two."""


@dataclass(frozen=True)
class DrivenSpeed:
    """The speed that a gait reaches.

    speeds    m/s, signed, at equally spaced headings; one where all are alike
    cycle     at the first heading
    reached   the extreme of what each limit bounds, SI; the torque without impacts of play
    effects   names of those simulated; left_out: of those that depend on the place
    """

    speeds: tuple[float, ...]
    cycle: Cycle
    reached: Mapping[str, float]
    effects: tuple[str, ...]
    left_out: tuple[str, ...]

    @property
    def speed(self) -> float:
        """The mean over the headings."""
        return float(np.mean(self.speeds))

    def error(self, claimed: float) -> float:
        """The largest difference from a claimed speed, relative."""
        return max(abs(speed - claimed) for speed in self.speeds) / abs(claimed)


def driven_speed(robot: Robot, gait: Gait) -> DrivenSpeed:
    """Drive a gait until its speed repeats. Raises NotConvergedError if it never does."""
    names = [use.name for use in robot.physics]
    placed = tuple(name for name in names if _depends(floor_motion((name,)), slice(0, 2)))
    effects = tuple(name for name in names if name not in placed)
    robot = replace(robot, physics=tuple(u for u in robot.physics if u.name in effects))
    system, motion = driven(effects)
    drive = servo_drive(robot, gait)
    t = np.linspace(0.0, gait.period, _SAMPLES + 1)
    fine = grain(effect_values(robot.physics), effects)
    path = drive_path(drive, steps_of(drive, t, 0.0, **fine), 0.0)
    p = values_of(robot, motion.parameters)
    tried = _HEADINGS if _depends(motion, slice(2, 3)) else 1
    headings = 2 * math.pi * np.arange(tried) / tried
    runs = [_steady(system, path, p, float(psi), motion.size) for psi in headings]
    cycles = [cycle_of(gait.period, *run[:3, :: path.each]) for run in runs]
    phi, rate, bend = drive.at(t)
    torque = motion.torque.map(len(t))
    drives = np.array([phi, rate, bend] if motion.slips else [phi, rate])
    at_samples = [
        np.abs(np.asarray(torque(run[:, :: path.each], drives, bend, p))).max() for run in runs
    ]
    speeds = motion.speeds.map(len(t))
    own = dynamics_of(robot)
    grip, values = own.grip.map(len(t)), own.values(robot)
    ahead = [speeds(run[:, :: path.each], drives, p)[0, :] for run in runs]
    needed = [np.abs(np.array(grip(v, phi, rate, bend, values))) for v in ahead]
    reached = {
        "angle": float(np.abs(phi).max()),
        "rate": linear_servo(robot).response_to(gait).peak_rate,
        "torque": float(max(at_samples)),
        "singularity": float(robot.S1(phi).min()),
        "grip": float(max(one.max() for one in needed)),
    }
    speeds = tuple(cycle.speed for cycle in cycles)
    return DrivenSpeed(speeds, cycles[0], reached, effects, placed)


def _depends(motion: FloorMotion, which: slice) -> bool:
    """Whether the speeds change with part of the pose."""
    inputs = motion.rates.sx_in()
    slopes = ca.jacobian(motion.rates(*inputs)[V:], inputs[0])
    return slopes[:, which].nnz() > 0


def _steady(system: System, path: DrivePath, p: Array, psi: float, size: int) -> Array:
    """The states of the steady period. The initial v is found by the secant method; side speeds, if
    any, settle by themselves."""
    start = np.zeros(size)
    start[2] = psi
    before, slope = (math.nan, math.nan), math.nan
    for _ in range(_ROUNDS):
        states = predict(system, path, start, p).states
        v, gap = float(start[V]), float(states[V, -1] - start[V])
        if not math.isfinite(gap):
            break
        if abs(gap) <= _REPEATS * np.abs(states[V]).max():
            return states
        # Side speeds that have not settled disturb the gap: a slope that friction cannot have, or
        # one that would lead far away, is theirs.
        secant = (gap - before[1]) / (v - before[0]) if v != before[0] else math.nan
        if -1 <= secant < 0 and (math.isnan(slope) or gap / before[1] < _NEARER):
            slope = secant
        before = v, gap
        start[V:] = states[V:, -1]
        start[V] = v + (math.copysign(_FIRST, gap) if math.isnan(slope) else -gap / slope)
    raise NotConvergedError("With all its effects, the robot does not settle to a periodic speed.")


@dataclass(frozen=True)
class DrivenOptimum:
    """The fastest gait of a robot driven with all its effects.

    beyond        names of the effects that multiple shooting does not model
    gait          as commanded
    robot, ratio  with the inertia ratio that goes with it
    driven        the speed that it reaches
    start         the speed that the optimum of multiple shooting reaches
    """

    beyond: tuple[str, ...]
    gait: Gait
    robot: Robot
    ratio: float
    driven: DrivenSpeed
    start: DrivenSpeed


_STARTS = 3
"""Optima from which the simplex method starts."""
_WORTH = 0.7
"""Optima slower than this share of the best are skipped."""
_PENALTY = 3.0
"""For a relative excess of 1 over a limit, as a multiple of the gait's speed."""


def unsteady_effects(robot: Robot) -> tuple[str, ...]:
    """The robot's effects on its motion that the steady-cycle equations do not model."""
    return tuple(
        use.name
        for use in robot.physics
        if use.name not in steady_effects() and CATALOGUE[use.name].port is not Port.MEASUREMENT
    )


def beyond_optimiser(robot: Robot) -> tuple[str, ...]:
    """Those of them that the optimiser does not account for by the servo's response."""
    return tuple(name for name in unsteady_effects(robot) if not CATALOGUE[name].linear)


def drive_optimum(optimum: Optimum) -> DrivenOptimum | None:
    """Simulate an optimum with all effects, and climb on from it if multiple shooting does not
    model them all; only from sine gaits, and not round a turn.

    None without an optimum, or if the optimum has all effects. Raises NotConvergedError as
    `driven_speed`.
    """
    best, robot, ratio = optimum.best, optimum.robot, optimum.ratio
    if best is None or robot is None or ratio is None or not unsteady_effects(robot):
        return None
    problem = optimum.problem
    command_for = problem.command.servo.command_for if problem.command else lambda gait: gait
    start = driven_speed(robot, command_for(best.gait))
    beyond = beyond_optimiser(robot)
    here = DrivenOptimum(beyond, command_for(best.gait), robot, ratio, start, start)
    if not beyond or not isinstance(best.gait, SineGait) or problem.turn:
        return here
    box = decisions(problem)
    setting = settings_of(problem, box)[0]
    choice = problem.inertia_ratio
    whole = choice is not None and choice.by == "loads" and choice.loads.whole
    free = [k for k in box.free if not (k == _SHARE and whole)]

    def driven_at(point: Array) -> tuple[Robot, Gait, DrivenSpeed]:
        amplitude, period, offset, share = map(float, box.physical(point[None])[:, 0])
        built, command = robot_of(setting, share), command_for(SineGait(amplitude, period, offset))
        return built, command, driven_speed(built, command)

    for one in optimum.optima[:_STARTS]:
        if abs(one.speed) < _WORTH * abs(best.speed):
            break

        def value(point: Array, sign: int = one.sign) -> float:
            try:
                seen = driven_at(point)[2]
            except NotConvergedError:
                return -math.inf
            _, excess = problem.limits.worst(seen.reached)
            return sign * seen.speed * (1 - _PENALTY * max(excess - LARGEST_EXCESS / 2, 0.0))

        gait = one.gait
        point = box.unit(gait.amplitude, gait.period, gait.offset, one.share)
        top, _ = _polished(value, point, free)
        built, command, seen = driven_at(top)
        kept = problem.limits.worst(seen.reached)[1] <= LARGEST_EXCESS
        if kept and abs(seen.speed) > abs(here.driven.speed) * (1 + _GAIN):
            about = choice.about if choice else "joint"
            here = DrivenOptimum(beyond, command, built, inertia_ratio(built, about), seen, start)
    return here


_SHARE = 3
"""Index of the ballast among the decisions."""


_SPAN, _RESTARTS, _GAIN = 0.05, 6, 1e-5
_WORST = 1e9


def _polished(
    value: Callable[[Array], float], point: Array, free: list[int]
) -> tuple[Array, float]:
    """The point (4,) that the simplex method reaches along the free coordinates, restarted until
    it gains nothing, and its value."""
    from scipy.optimize import minimize  # compiled code does without

    best, top = point.copy(), value(point)

    def cost(x: Array) -> float:
        there = best.copy()
        there[free] = x
        # Must be finite, or the simplex cannot be ordered.
        return min(-value(there), _WORST)

    for _ in range(_RESTARTS if free else 0):
        corner = best[free]
        simplex = corner + np.vstack([np.zeros(len(free)), _SPAN * np.eye(len(free))])
        simplex = np.where(simplex > 1, 2 * corner - simplex, simplex)
        how = {"initial_simplex": simplex, "xatol": 1e-6, "fatol": 1e-8, "maxfev": 300}
        bounds = [(0.0, 1.0)] * len(free)
        found = minimize(cost, corner, method="Nelder-Mead", bounds=bounds, options=how)
        gain = -float(found.fun) - top
        if gain > 0:
            top += gain
            best[free] = found.x
        if gain <= _GAIN * max(abs(top), 1e-3):
            break
    return best, top
