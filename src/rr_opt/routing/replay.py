"""A drive simulated by CVODES from rest, independently of the optimiser, from its command."""

import math
from dataclasses import dataclass
from functools import lru_cache

import casadi as ca
import numpy as np

from rr_opt.array import Array
from rr_opt.model.command import Command, blended
from rr_opt.model.problem import Problem
from rr_opt.model.route import Pose
from rr_opt.motion.dynamics import derive, dynamics_of
from rr_opt.motion.steady_cycle import Trajectory
from rr_opt.routing.path import Leg

_CVODES = {"reltol": 1e-10, "abstol": 1e-12, "max_num_steps": 1_000_000}
_RATE = 200.0
"""Samples a second."""
_SAME = 1e-9
"""s: times closer than this count as one."""
_APART = 2e-3
"""m: spacing of the path points from which distances are measured."""


@dataclass(frozen=True)
class RouteReplay:
    """The result of the simulation.

    position   distance of P from the end of the route, m
    heading    of platform 1 relative to the requested one, rad
    speed      of axle 1 at the end, m/s
    path       largest distance of P from the path, m
    reached    extreme of each limited quantity: rate (rad/s), angle (rad), torque (N m),
               singularity (least S1, m), grip (largest side force of an axle over the load on it)
    when       it is reached, s
    excess     largest relative violation of a limit; negative if all are satisfied
    """

    trajectory: Trajectory
    position: float
    heading: float
    speed: float
    path: float
    reached: dict[str, float]
    when: dict[str, float]
    excess: float


def replay(
    problem: Problem,
    command: Command,
    start: Pose,
    legs: tuple[Leg, ...],
    turned: float,
    heading: float,
) -> RouteReplay:
    """Simulate a command; turned: heading of platform 1 at the start relative to the path, rad;
    heading: the requested one at the end, rad."""
    driven = simulate(problem, command, start, turned)
    end = legs[-1].end
    found = peaks(problem, command, driven)
    reached = {name: value for name, (value, _) in found.items()}
    return RouteReplay(
        driven,
        math.hypot(driven.x[-1] - end.x, driven.y[-1] - end.y),
        abs(float(driven.psi[-1]) - heading),
        abs(float(driven.v[-1])),
        float(distances(legs, driven.x, driven.y).max()),
        reached,
        {name: when for name, (_, when) in found.items()},
        problem.limits.worst(reached)[1],
    )


def peaks(problem: Problem, command: Command, driven: Trajectory) -> dict[str, tuple[float, float]]:
    """The extreme of each limited quantity and its time, s: between samples, at the vertex of a
    parabola, and on either side of a knot, where the acceleration jumps."""
    robot, dynamics = problem.robot, dynamics_of(problem.robot)
    p = dynamics.values(robot)
    found: dict[str, tuple[float, float]] = {}
    for u, begin in zip(command.segments.T, command.times, strict=False):
        first, last = np.searchsorted(driven.t, [begin - _SAME, begin + u[7] + _SAME])
        t = driven.t[first:last]
        path = np.array(blended((t - begin) / u[7], u, np.sin, np.cos))
        inputs = [driven.v[None, first:last], *path[:, None], np.tile(p[:, None], len(t))]
        loads = dynamics.motion(*inputs)[3], *dynamics.grip(*inputs)
        torque, *grips = (np.abs(np.asarray(load)).ravel() for load in loads)
        sizes = [("angle", np.abs(path[0])), ("rate", np.abs(path[1]))]
        sizes.append(("singularity", -robot.S1(path[0])))
        for name, size in (*sizes, ("torque", torque), *(("grip", grip) for grip in grips)):
            k = int(size.argmax())
            value, when = float(size[k]), float(t[k])
            if 0 < k < len(t) - 1:
                left, right = size[k - 1] - size[k], size[k + 1] - size[k]
                moved = 0.5 * (left - right) / min(left + right, -1e-300)
                value -= 0.25 * (left - right) * moved
                when += moved * (t[k + 1] - t[k])
            if value > found.get(name, (-math.inf, 0.0))[0]:
                found[name] = float(value), float(when)
    least, when = found["singularity"]
    return {**found, "singularity": (-least, when)}


def distances(legs: tuple[Leg, ...], x: Array, y: Array) -> Array:
    """Distance of points from the path, m."""
    from scipy.spatial import KDTree

    poses = [
        leg.at(s) for leg in legs for s in np.linspace(0, leg.length, int(leg.length / _APART) + 2)
    ]
    tree = KDTree([(pose.x, pose.y) for pose in poses])
    return np.asarray(tree.query(np.stack([x, y], axis=1))[0])


def simulate(problem: Problem, command: Command, start: Pose, turned: float) -> Trajectory:
    """The motion from rest, with at least `rate` samples a second, and one at every knot."""
    dynamics = dynamics_of(problem.robot)
    p = dynamics.values(problem.robot)
    state = np.array([0.0, start.heading + turned, start.x, start.y])
    states, times = [state[:, None]], [np.zeros(1)]
    for u, begin in zip(command.segments.T, command.times, strict=False):
        count = max(2, math.ceil(u[7] * _RATE))
        out = np.asarray(_integrator(dynamics.effects, count)(x0=state, p=np.append(u, p))["xf"])
        states.append(out)
        times.append(begin + u[7] * np.arange(1, count + 1) / count)
        state = out[:, -1]
    v, psi, x, y = np.hstack(states)
    t = np.concatenate(times)
    t[-1] = command.seconds
    path = command.at(t)
    inputs = [v[None], *path[:, None], np.tile(p[:, None], len(t))]
    torque = np.asarray(dynamics.motion(*inputs)[3]).ravel()
    return Trajectory(t, x, y, psi, path[0], v, torque)


@lru_cache
def _integrator(effects: tuple[str, ...], count: int) -> ca.Function:
    dynamics = derive(effects)
    y, s, u = ca.SX.sym("y", 4), ca.SX.sym("s"), ca.SX.sym("u", 8)
    p = ca.SX.sym("p", len(dynamics.parameters))
    vdot, w, side, _ = dynamics.motion(y[0], *blended(s, ca.vertsplit(u), ca.sin, ca.cos), p)
    cos, sin = ca.cos(y[1]), ca.sin(y[1])
    rates = ca.vertcat(vdot, w, y[0] * cos - side * sin, y[0] * sin + side * cos)
    dae = {"x": y, "t": s, "p": ca.vertcat(u, p), "ode": u[7] * rates}
    return ca.integrator("replay", "cvodes", dae, 0.0, np.arange(1, count + 1) / count, _CVODES)
