"""A path near what was recorded, and the linear motion about it.

How the measured angle may leave its command: smooth deviations, and whether there are any.

Harmonics of the cycle, a slow change of the first of them, and what a start from rest adds in the
first period.

A path near what was recorded, about which every stage is linear.

It follows the data and not the model, so that a fault of any size leaves the linearisation good.
The angle is the command, or where that is not what was measured, the command and a smooth
deviation.

Where a fault can push the no-slip robot, as functions evaluated over whole runs at once.

The side speeds s1, s2 move P and turn platform 1; a force along a platform's axis at its axle, or a
moment on a platform, accelerates v through its partial velocity. Everything is CasADi's derivative
of `physics.kinematics` and `physics.kane`; no formula is written down twice.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields
from functools import lru_cache

import casadi as ca
import numpy as np
from scipy.interpolate import BSpline, CubicSpline
from scipy.linalg import eigh
from scipy.sparse import csr_array
from scipy.stats import chi2

from rr_opt.array import Array
from rr_opt.machines.racer.racer import RollerRacer
from rr_opt.mechanics.drive import commanded
from rr_opt.mechanics.kane import Equations, equations
from rr_opt.mechanics.kinematics import ROBOT_PARAMETERS, Mechanism, mechanism, rotated
from rr_opt.mechanics.vectorised import ArrayFunction, over_arrays
from rr_opt.motion.floor_motion import FloorMotion, floor_motion
from rr_opt.sysid.model import Data

_DEGREE = 3


def columns(t: Array, spacing: float) -> tuple[Array, Array]:
    """Cubic B-splines (n, m) over t (n,), knots about `spacing` s apart; and their rates."""
    count = max(int(np.ceil((t[-1] - t[0]) / spacing)), 1)
    inner = np.linspace(t[0], t[-1], count + 1)
    knots = np.concatenate([[inner[0]] * _DEGREE, inner, [inner[-1]] * _DEGREE])
    spline = BSpline(knots, np.eye(count + _DEGREE), _DEGREE)
    return spline(t), spline.derivative()(t)


def smooth(B: Array, y: Array) -> Array:
    """Coefficients (m, k) of cubic B-splines B (n, m) that follow y (n, k), in sigmas, NaN: none.

    They bend as much as is likeliest for data with unit noise: where y is noise alone, straight
    lines come out, and where it is not, they follow it.
    """
    seen = np.isfinite(y).all(axis=1)
    sparse = csr_array(B[seen])
    A = (sparse.T @ sparse).toarray()
    A[np.diag_indices_from(A)] += 1e-6 * np.trace(A) / len(A)
    bend = np.diff(np.eye(len(A)), 2, axis=0)
    stiff, vectors = eigh(bend.T @ bend, A)
    bends = stiff > 1e-9 * stiff[-1]
    c = vectors.T @ (sparse.T @ y[seen])
    # A bending mode of stiffness s has the variance 1/(weight s) beside the noise's 1.
    weights = 10.0 ** np.arange(-4, 14, 0.5)
    variance = 1 + 1 / (weights[:, None] * stiff[bends])
    fit = np.log(variance).sum(axis=1)[:, None] + 1 / variance @ c[bends] ** 2
    best = weights[np.argmin(fit, axis=0)]
    return vectors @ (c / (1 + np.where(bends, stiff, 0.0)[:, None] * best))


def hats(x: Array, nodes: Array) -> Array:
    """Piecewise linear functions (n, m) of x (n,): each 1 at its node, 0 at the others."""
    return np.column_stack([np.interp(x, nodes, e) for e in np.eye(len(nodes))])


HARMONICS = 8
_TRANSIENT = 6
_FOLLOW = 1e-3
"""Above this chance of noise alone the angle is its command."""


def deviates(model: RollerRacer, runs: Sequence[int]) -> bool:
    """Whether the angle is not its command in these runs, together.

    If it is, no more is to be known of it: the motion of half a minute depends on the angle more
    finely than the angle can be measured.
    """
    worth, dof = 0.0, 0
    for run in runs:
        here, data = model.experiment.runs[run], model.runs[run]
        rest = here.start == "rest"
        wiggle = wiggles(data.t, here.gait.period, rest)[0]
        _, own, rank = deviation(wiggle, data, commanded(here.gait, rest).at(data.t)[0])
        worth, dof = worth + own, dof + rank
    return bool(chi2.sf(worth, dof) < _FOLLOW)


def deviation(wiggle: Array, data: Data, command: Array) -> tuple[Array, float, int]:
    """Coefficients of the deviation, the chi-square that they explain, and their number."""
    off = (data.values[:, 3] - command) / data.sigma[:, 3]
    seen = np.isfinite(off)
    W, y = wiggle[seen] / data.sigma[seen, 3, None], off[seen]
    beta, _, rank, _ = np.linalg.lstsq(W, y, rcond=None)
    return np.asarray(beta, float), float(y @ y - np.sum((y - W @ beta) ** 2)), int(rank)


def wiggles(t: Array, period: float, rest: bool) -> tuple[Array, Array, Array]:
    """The deviations of the angle (n, nb), and their first and second derivatives."""
    omega = 2 * np.pi / period
    k = omega * np.arange(1, HARMONICS + 1)
    c, s = np.cos(np.outer(t, k)), np.sin(np.outer(t, k))
    one, zero = np.ones((t.size, 1)), np.zeros((t.size, 1))
    slow = ((t - t.mean()) / (t[-1] - t[0]))[:, None]
    d = 1 / (t[-1] - t[0])
    c1, s1, w = c[:, :1], s[:, :1], omega
    value = [one, c, s, slow, slow * c1, slow * s1]
    first = [zero, -k * s, k * c, d * one, d * c1 - w * slow * s1, d * s1 + w * slow * c1]
    second = [
        *(zero, -k * k * c, -k * k * s, zero),
        *(-2 * d * w * s1 - w * w * slow * c1, 2 * d * w * c1 - w * w * slow * s1),
    ]
    if rest:
        early = t - t[0] <= period
        B, dB = columns(t[early], period / _TRANSIENT)
        # The last three would not fade out at the end of the period.
        m = B.shape[1] - 3
        for parts, own in ((value, B), (first, dB), (second, np.gradient(dB, t[early], axis=0))):
            part = np.zeros((t.size, m))
            part[early] = own[:, :m]
            parts.append(part)
    return np.hstack(value), np.hstack(first), np.hstack(second)


KNOTS_IN_PERIOD = 8


@dataclass(frozen=True)
class Path:
    """The path of a run; n samples, times in s, SI.

    phase    of the command, 0 to 1;  told (3, n) the command and its derivatives
    wiggle   (n, nw) deviations that the angle may have;  drive (3, n) phi, dphi, ddphi
    free     (n, nb) those that it has, free_rate theirs: all, or none if it keeps its command
    pose     (n, 3) x, y, psi;  v (n,) speed of P along platform 1
    data     (n, 4) recorded, sigma (n, 4), NaN where there is nothing
    """

    run: int
    t: Array
    period: float
    rest: bool
    phase: Array
    told: Array
    wiggle: Array
    free: Array
    free_rate: Array
    drive: Array
    pose: Array
    v: Array
    data: Array
    sigma: Array


def path(model: RollerRacer, run: int, predicted: Array, *, follow: bool) -> Path:
    """The path of a run.

    predicted  (n, 4) by a fit of the parameters: where it does as well as the data allow, the path
               is that, and has no noise of its own, which the squares of noise would bias
    follow     whether the angle is what was measured, or the command
    """
    here, data = model.experiment.runs[run], model.runs[run]
    t, period, rest = data.t, here.gait.period, here.start == "rest"
    command = commanded(here.gait, rest).at(t)
    wiggle, rate, bend = wiggles(t, period, rest)
    beta = np.zeros(wiggle.shape[1])
    if follow:
        beta = deviation(wiggle, data, command[0])[0]
    drive = command + np.array([wiggle @ beta, rate @ beta, bend @ beta])
    B, dB = columns(t, max(period / KNOTS_IN_PERIOD, 4 * float(np.median(np.diff(t)))))
    sigma = np.nanmedian(data.sigma[:, :3], axis=0)
    C = smooth(B, (data.values[:, :3] - predicted[:, :3]) / sigma) * sigma
    pose = predicted[:, :3] + B @ C
    moving = CubicSpline(t, predicted[:, :3]).derivative()(t) + dB @ C
    v = moving[:, 0] * np.cos(pose[:, 2]) + moving[:, 1] * np.sin(pose[:, 2])
    free, free_rate = (part if follow else part[:, :0] for part in (wiggle, rate))
    return Path(
        run, t, period, rest, t / period % 1.0, command, wiggle, free, free_rate, drive, pose, v,
        data.values, data.sigma,
    )  # fmt: skip


SHAPES = (
    "quadratic_drag",
    "left_right_drag",
    "wheel_inertia",
    "axle_misalignment",
    "floor_tilt",
    "com_offset",
)
"""Effects of the catalogue whose derivatives serve as shapes; all vanish smoothly."""

NAMES = (
    *("x_by_s1", "y_by_s1", "psi_by_s1", "x_by_s2", "y_by_s2", "psi_by_s2"),
    *("v", "u2", "w", "by_force1", "by_force2", "by_moment", "side1", "side2"),
)
"""What `ports` returns: pose rates by side speed; speeds of both axles along their platforms (m/s)
and psi-dot; v-dot by a force along each axle (1/kg) and by a moment (1/(kg m)); and the side forces
(N) that hold the axles."""


@lru_cache
def ports() -> ArrayFunction:
    """(psi, phi, z, dphi, ddphi, *robot parameters) -> NAMES."""
    robot = mechanism()
    kane = equations(robot)
    frame, u, udot = robot.frames[1], robot.speeds, kane.udot
    joint = rotated(frame.velocity(robot.joint(1)), robot.pose[2])
    moved = ca.jacobian(ca.vertcat(joint, frame.rate), u[1:3])
    held = ca.vertcat(u[1:3], udot[1:3])
    u2, w = robot.frames[2].origin[0], frame.rate
    along = ca.vertcat(1, ca.jacobian(u2, u[0]), ca.jacobian(w, u[0]))
    parts = ca.vertcat(moved[:, 0], moved[:, 1], u[0], u2, w, along, kane.needed)
    inertia = ca.jacobian(kane.needed[0], udot[0])
    resting = ca.substitute(kane.needed[0], udot[0], 0)
    parts = ca.substitute(parts, udot[0], -resting / inertia)
    z, dphi, ddphi = ca.SX.sym("z"), ca.SX.sym("dphi"), ca.SX.sym("ddphi")
    everything = ca.substitute(ca.vertcat(parts, inertia), held, ca.SX.zeros(4))
    speeds = ca.vertcat(z + _swing(robot, kane) * dphi, dphi, ddphi)
    out = ca.substitute(everything, ca.vertcat(u[0], u[3], udot[3]), speeds)
    mass = out[16]
    shown = ca.vertcat(out[:9], out[9:12] / mass, out[13:15])
    p = ca.vertcat(*(robot.parameters[name] for name in ROBOT_PARAMETERS))
    inputs = [robot.pose[2], robot.phi, z, dphi, ddphi, p]
    return over_arrays(ca.Function("ports", inputs, [ca.cse(ca.densify(shown))]))


@lru_cache
def swing() -> ArrayFunction:
    """(phi, *robot parameters) -> v by dphi at a fixed z, m."""
    robot = mechanism()
    p = ca.vertcat(*(robot.parameters[name] for name in ROBOT_PARAMETERS))
    g = ca.cse(ca.densify(_swing(robot, equations(robot))))
    return over_arrays(ca.Function("swing", [robot.phi, p], [g]))


def _swing(robot: Mechanism, kane: Equations) -> ca.SX:
    udot = kane.udot
    balance = kane.needed[0]
    g = -ca.jacobian(balance, udot[3]) / ca.jacobian(balance, udot[0])
    held = ca.vertcat(robot.speeds[1:3], udot[1:3])
    return ca.substitute(g, held, ca.SX.zeros(4))


@lru_cache
def linearised() -> tuple[FloorMotion, ArrayFunction, ArrayFunction]:
    """The motion with SHAPES, its rates, and their Jacobian by state, drive and p, by column."""
    motion = floor_motion(SHAPES)
    inputs = motion.rates.sx_in()
    by = ca.densify(ca.jacobian(motion.rates(*inputs), ca.vertcat(*inputs)))
    jacobian = ca.Function("rates_by", inputs, [ca.cse(by)])
    return motion, over_arrays(motion.rates), over_arrays(jacobian)


@dataclass(frozen=True)
class Reference(Path):
    """A path and the linear motion about it.

    z        (n,) v - g dphi
    by_state (n, 4, 4), by_drive (n, 4, 2), by_p (n, 4, np): Jacobian of the rates of x, y, psi, z
    missed   (n, 4) by how much the path leaves the equations: path less the integral of its rates
    ports    `ports.NAMES`, each (n,)
    """

    z: Array
    by_state: Array
    by_drive: Array
    by_p: Array
    missed: Array
    ports: dict[str, Array]


def integral(t: Array, f: Array) -> Array:
    """Of f (n, ...) from the first time on: trapezia and Euler's and Maclaurin's correction."""
    wide = (slice(None), *(None,) * (f.ndim - 1))
    h = np.diff(t)[wide]
    slope = np.empty_like(f)
    np.subtract(f[2:], f[:-2], out=slope[1:-1])
    slope[1:-1] /= (t[2:] - t[:-2])[wide]
    slope[0] = 2 * (f[1] - f[0]) / h[0] - slope[1]
    slope[-1] = 2 * (f[-1] - f[-2]) / h[-1] - slope[-2]
    bent = np.subtract(slope[:-1], slope[1:])
    bent *= h / 6
    bent += f[1:]
    bent += f[:-1]
    bent *= h / 2
    out = np.zeros_like(f)
    np.cumsum(bent, axis=0, out=out[1:])
    return out


def reference(along: Path, p: Array) -> Reference:
    """The linear motion about a path; p: values of the linearised motion's parameters."""
    motion, rates, by = linearised()
    t, pose, drive = along.t, along.pose, along.drive
    own = [p[motion.parameters.index(name)] for name in ROBOT_PARAMETERS]
    z = along.v - swing()(drive[0], *own)[0] * drive[1]
    shown = np.broadcast_arrays(*ports()(pose[:, 2], drive[0], z, *drive[1:], *own))
    state = (*pose.T, z)
    J = np.array(np.broadcast_arrays(*by(*state, *drive[:2], *p), t)[:-1])
    J = J.reshape(-1, 4, t.size).transpose(2, 1, 0)
    f = np.array(np.broadcast_arrays(*rates(*state, *drive[:2], *p))).T
    stated = np.column_stack([pose, z])
    return Reference(
        **{own.name: getattr(along, own.name) for own in fields(Path)},
        z=z,
        by_state=J[:, :, :4],
        by_drive=J[:, :, 4:6],
        by_p=J[:, :, 6:],
        missed=stated - stated[0] - integral(t, f),
        ports=dict(zip(NAMES, shown, strict=True)),
    )
