"""A drive simulated by CVODES from rest, as if nothing were known of it but its command."""

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
_APART = 2e-3
"""m: points of the path from which distances are measured."""


@dataclass(frozen=True)
class RouteReplay:
    """What the simulation says.

    position   distance of P from the end of the route, m
    heading    of platform 1 against the one asked for, rad
    speed      of axle 1 at the end, m/s
    path       largest distance of P from the path, m
    reached    extreme of each limited quantity: rate (rad/s), angle (rad), torque (N m),
               singularity (least S1, m), grip (largest side force of an axle over the load on it)
    excess     by how much the worst limit is exceeded, relative to it; negative if all are kept
    """

    trajectory: Trajectory
    position: float
    heading: float
    speed: float
    path: float
    reached: dict[str, float]
    excess: float


def replay(
    problem: Problem,
    command: Command,
    start: Pose,
    legs: tuple[Leg, ...],
    turned: float,
    heading: float,
) -> RouteReplay:
    """Simulate a command; turned: heading of platform 1 at the start against that of the path, rad;
    heading: the one it is to have at the end, rad."""
    robot = problem.robot
    driven = simulate(problem, command, start, turned)
    end = legs[-1].end
    fine = command.at(np.linspace(0, command.seconds, max(len(driven.t), 10) * 10))
    S1 = robot.platform1.c * np.cos(fine[0]) + robot.platform2.c
    reached = {
        "rate": float(np.abs(fine[1]).max()),
        "angle": float(np.abs(fine[0]).max()),
        "torque": float(np.abs(driven.torque).max()),
        "singularity": float(S1.min()),
        "grip": max(grip_needed(problem, command, driven)),
    }
    return RouteReplay(
        driven,
        math.hypot(driven.x[-1] - end.x, driven.y[-1] - end.y),
        abs(float(driven.psi[-1]) - heading),
        abs(float(driven.v[-1])),
        float(distances(legs, driven.x, driven.y).max()),
        reached,
        problem.limits.worst(reached)[1],
    )


def grip_needed(problem: Problem, command: Command, driven: Trajectory) -> tuple[float, float]:
    """Of axles 1 and 2 the largest side force over the load on them, at all samples."""
    dynamics = dynamics_of(problem.robot)
    p = np.tile(dynamics.values(problem.robot)[:, None], len(driven.t))
    sides = dynamics.grip(driven.v[None], *command.at(driven.t)[:, None], p)
    one, two = (float(np.abs(np.asarray(side)).max()) for side in sides)
    return one, two


def distances(legs: tuple[Leg, ...], x: Array, y: Array) -> Array:
    """Distance of points from the path, m."""
    from scipy.spatial import KDTree

    poses = [
        leg.at(s) for leg in legs for s in np.linspace(0, leg.length, int(leg.length / _APART) + 2)
    ]
    tree = KDTree([(pose.x, pose.y) for pose in poses])
    return np.asarray(tree.query(np.stack([x, y], axis=1))[0])


def simulate(problem: Problem, command: Command, start: Pose, turned: float) -> Trajectory:
    """The motion from rest, at least `rate` samples a second, and at every knot."""
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
