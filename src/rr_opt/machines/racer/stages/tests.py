"""Tests of the servo, the axles and the balance of forces, each on its own.

Does the measured angle follow its command? The channel phi alone; no dynamics, no geometry.

Its residual is white noise where nothing is wrong. A clock that is off moves the command as a whole
and leaves nothing; a servo that is slow, limited, loose or off does not, as its swing changes too.

Does the motion obey the axles? The side speed of each, from the measured motion alone.

v may be any smooth function of time here, so no force and no mass counts. What is left of x, y and
psi are two relations, one for each axle, which the lengths c1, c2 and the place of the tracked
point share. Each run is cut into windows with starts of their own.

Do the forces balance? v follows from them here, with the measured angle as the input.

The robot has one speed, so a force along a platform and a moment on it show in the same equation,
and only their shapes tell them apart. In the mirror (phi, psi, y to -phi, -psi, -y) what resists
rolling is even, and what pulls to one side is odd: left and right wheels that differ, a mass beside
the axis. What resists may change with the time. A fault of the floor knows its place or heading.
"""

from __future__ import annotations

import itertools
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from rr_opt.array import Array
from rr_opt.machines.racer.racer import RollerRacer
from rr_opt.machines.racer.stages.gram import Gram, Known, Worth, eliminated, products
from rr_opt.machines.racer.stages.reference import Reference, columns, hats, linearised
from rr_opt.machines.racer.stages.respond import missed, path_of, start_of, wiggled
from rr_opt.mechanics.drive import commanded
from rr_opt.sysid.diagnosis import Curve

_BINS = {"phase": 12, "speed": 6, "heading": 8, "along": 6, "across": 6, "time": 6}
_UNITS = {
    "phase": "cycle", "speed": "m/s", "heading": "rad", "along": "m", "across": "m", "time": "s",
}  # fmt: skip


@dataclass(frozen=True)
class Variable:
    """What a curve may be drawn over: nodes (m,) in a unit; around, if they close a circle."""

    name: str
    unit: str
    nodes: Array
    around: bool

    def columns(self, ref: Reference) -> Array:
        """Hats (n, m) over a run."""
        x = _of(self.name, ref)
        if not self.around:
            return hats(x, self.nodes)
        step = self.nodes[1] - self.nodes[0]
        x = (x - self.nodes[0]) % (step * self.nodes.size)
        out = hats(x, step * np.arange(self.nodes.size + 1))
        out[:, 0] += out[:, -1]
        return out[:, :-1]


def variables(refs: Sequence[Reference]) -> tuple[Variable, ...]:
    """Phase, speed, heading, place along x and across it, and time, over all runs."""
    out = []
    for name, count in _BINS.items():
        if name == "phase":
            out.append(Variable(name, "cycle", np.arange(count) / count, True))
        elif name == "heading":
            out.append(Variable(name, "rad", -np.pi + 2 * np.pi * np.arange(count) / count, True))
        else:
            x = np.concatenate([_of(name, ref) for ref in refs])
            low, high = (float(q) for q in np.percentile(x, [1, 99]))
            nodes = np.linspace(low, high, count)
            out.append(Variable(name, _UNITS[name], nodes, False))
    return tuple(out)


def _of(name: str, ref: Reference) -> Array:
    return {
        "phase": lambda: ref.phase,
        "speed": lambda: ref.ports["v"],
        "heading": lambda: ref.pose[:, 2],
        "along": lambda: ref.pose[:, 0],
        "across": lambda: ref.pose[:, 1],
        "time": lambda: ref.t - ref.t[0],
    }[name]()


_ROUNDS = 6


@dataclass(frozen=True)
class Servo:
    """What the angle says.

    clock   chi-square that one clock for all runs, `offset` s late, explains
    servo   chi-square that smooth deviations from this clock's command explain
    """

    clock: Worth
    servo: Worth
    offset: float
    count: int
    curves: tuple[Curve, ...]


def servo_test(model: RollerRacer, refs: Sequence[Reference]) -> Servo:
    """Test the angle of all runs against its command."""
    offset = 0.0
    costs, late = [], []
    for _ in range(_ROUNDS):
        late = [_residual(model, ref, offset) for ref in refs]
        costs.append(sum(float(r @ r) for r, _ in late))
        slope = sum(float(d @ d) for _, d in late)
        offset += sum(float(r @ d) for r, d in late) / max(slope, 1e-300)
    left = [_explained(ref, r) for ref, (r, _) in zip(refs, late, strict=True)]
    dof = sum(rank for _, rank in left) - 1
    return Servo(
        Worth(max(costs[0] - costs[-1], 0.0), 1),
        Worth(sum(gain for gain, _ in left), dof),
        offset,
        sum(r.size for r, _ in late),
        _curves(refs),
    )


def _residual(model: RollerRacer, ref: Reference, offset: float) -> tuple[Array, Array]:
    """(recorded - command)/sigma where there is something, and its slope by the clock's offset."""
    here = model.experiment.runs[ref.run]
    command = commanded(here.gait, here.start == "rest").at(ref.t + offset)
    r = (ref.data[:, 3] - command[0]) / ref.sigma[:, 3]
    seen = np.isfinite(r)
    return r[seen], (command[1] / ref.sigma[:, 3])[seen]


def _explained(ref: Reference, r: Array) -> tuple[float, int]:
    seen = np.isfinite(ref.data[:, 3])
    W = ref.wiggle[seen] / ref.sigma[seen, 3, None]
    W /= np.maximum(np.linalg.norm(W, axis=0), 1e-300)
    U, s, _ = np.linalg.svd(W, full_matrices=False)
    U = U[:, s > 1e-8 * s[0]]
    return float(np.sum((U.T @ r) ** 2)), U.shape[1]


def _curves(refs: Sequence[Reference]) -> tuple[Curve, ...]:
    """The mean residual in sigma in bins of phase, commanded rate and time."""
    seen = [np.isfinite(ref.data[:, 3]) for ref in refs]
    r = np.concatenate([((ref.data[:, 3] - ref.told[0]) / ref.sigma[:, 3])[k]
                        for ref, k in zip(refs, seen, strict=True)])  # fmt: skip
    axes = {
        ("phase", "cycle", 24): [ref.phase[k] for ref, k in zip(refs, seen, strict=True)],
        ("rate", "rad/s", 12): [ref.told[1][k] for ref, k in zip(refs, seen, strict=True)],
        ("time", "s", 12): [(ref.t - ref.t[0])[k] for ref, k in zip(refs, seen, strict=True)],
    }
    return tuple(_binned(*key, np.concatenate(x), r) for key, x in axes.items())


def _binned(name: str, unit: str, bins: int, x: Array, r: Array) -> Curve:
    edges = np.linspace(x.min(), x.max(), bins + 1)
    own = np.clip(np.searchsorted(edges, x, side="right") - 1, 0, bins - 1)
    count = np.bincount(own, minlength=bins)
    full = count > 0
    mean = np.bincount(own, r, minlength=bins)[full] / count[full]
    at = ((edges[1:] + edges[:-1]) / 2)[full]
    return Curve(name, unit, at, mean, 1 / np.sqrt(count[full]))


WINDOW = 5.0
"""s."""

KNOTS_IN_PERIOD = 10
"""Of v in a period of the command."""

TOE, SLIP, POINT = 0.01, 1e-3, 1e-3
"""Units of the columns: rad, m/s, m."""

_LOADS = np.array([0.0, 0.3, 0.6, 0.8, 1.0])
"""Nodes of the side speed as a function of the side force, in its largest."""


def kinematic_gram(refs: Sequence[Reference], known: Known, variables: Sequence[Variable]) -> Gram:
    """Blocks `lengths` (the known), `point` (dx, dy), `axle1`, `axle2`, axles by each variable."""
    most = side_forces(refs)
    sizes = {
        "lengths": len(known.quantities),
        "point": 2,
        "axle1": _LOADS.size,
        "axle2": _LOADS.size,
    }
    sizes |= {f"axle{i} by {x.name}": x.nodes.size for i in (1, 2) for x in variables}
    ends = np.cumsum([0, *sizes.values()])
    blocks = {name: slice(a, b) for name, a, b in zip(sizes, ends[:-1], ends[1:], strict=True)}
    total = known.prior(int(ends[-1]) + 1)
    count = 0
    by = known.changes()
    for ref in refs:
        own, seen = _of_run(ref, by, most, variables)
        total += own
        count += seen
    return Gram(total, blocks, ("lengths",), count)


def shift_gram(refs: Sequence[Reference], most: Sequence[float]) -> Array:
    """Products of how far `point`, `axle1` and `axle2` shift whole runs, v unchanged."""
    total: Array = np.zeros((2 + 2 * _LOADS.size, 2 + 2 * _LOADS.size))
    for ref in refs:
        span = slice(0, ref.t.size)
        sides = np.concatenate([_side(ref, i, axle(ref, i, most[i - 1])) for i in (1, 2)], axis=2)
        moved = path_of(ref, sides, span, held=True)[:, :3]
        C = np.concatenate([_point(ref), moved], axis=2) / ref.sigma[:, :3, None]
        L = start_of(ref, span, held=True)[:, :3] / ref.sigma[:, :3, None]
        seen = np.isfinite(ref.data[:, :3])
        total += products(L[seen], C[seen])
    return total


def side_forces(refs: Sequence[Reference]) -> list[float]:
    """The largest side force on each axle, N, but for a hundredth of the time."""
    return [
        float(np.percentile(np.abs(np.concatenate([ref.ports[f"side{i}"] for ref in refs])), 99))
        for i in (1, 2)
    ]


def _of_run(
    ref: Reference, by: Array, most: Sequence[float], variables: Sequence[Variable]
) -> tuple[Array, int]:
    wiggles = wiggled(ref)
    nb = wiggles.shape[2]
    pushes = [wiggles, np.einsum("nip,pq->niq", ref.by_p, by)]
    sides = [_side(ref, i, axle(ref, i, most[i - 1])) for i in (1, 2)]
    curves = [_side(ref, i, SLIP * x.columns(ref)) for i in (1, 2) for x in variables]
    pushes = np.concatenate([*pushes, *sides, *curves], axis=2)
    pushes[:, 3] = 0.0
    point = _point(ref)
    at = nb + by.shape[1]
    phi = np.column_stack([ref.free, np.zeros((ref.t.size, pushes.shape[2] - nb + 2)),
                           ref.data[:, 3] - ref.drive[0]]) / ref.sigma[:, 3, None]  # fmt: skip
    phi = phi[np.isfinite(phi).all(axis=1)]
    S, count = phi.T @ phi, len(phi)
    for span in _windows(ref.t):
        moved = path_of(ref, pushes[span], span, held=True)
        moved = np.concatenate([moved[:, :3, :at], point[span], moved[:, :3, at:]], axis=2)
        left = ref.data[span, :3] - ref.pose[span] - missed(ref, span, held=True)[:, :3]
        C = np.concatenate([moved, left[:, :, None]], axis=2) / ref.sigma[span, :3, None]
        L = _free(ref, span) / ref.sigma[span, :3, None]
        seen = np.isfinite(left)
        if seen.sum() > 2 * L.shape[2]:
            S += products(L[seen], C[seen])
            count += int(seen.sum())
    return eliminated(S, nb), count


def axle(ref: Reference, i: int, most: float) -> Array:
    """Side speeds (n, m) that a turned or slipping axle may have, m/s."""
    load = ref.ports[f"side{i}"] / most
    law = np.sign(load)[:, None] * hats(np.abs(load), _LOADS)[:, 1:]
    roll = ref.ports["v" if i == 1 else "u2"]
    return np.column_stack([TOE * roll, SLIP * law])


def _side(ref: Reference, i: int, speeds: Array) -> Array:
    out = np.zeros((ref.t.size, 4, speeds.shape[1]))
    for k, name in enumerate(("x", "y", "psi")):
        out[:, k] = ref.ports[f"{name}_by_s{i}"][:, None] * speeds
    return out


def _point(ref: Reference) -> Array:
    c, s = np.cos(ref.pose[:, 2]), np.sin(ref.pose[:, 2])
    zero = np.zeros_like(c)
    return POINT * np.array([[c, -s], [s, c], [zero, zero]]).transpose(2, 0, 1)


def _free(ref: Reference, span: slice) -> Array:
    t = ref.t[span]
    B = columns(t, max(ref.period / KNOTS_IN_PERIOD, 4 * float(np.median(np.diff(t)))))[0]
    pushes = np.zeros((t.size, 4, B.shape[1]))
    pushes[:, 3] = B
    moved = path_of(ref, pushes, span, held=True)
    return np.concatenate([start_of(ref, span, held=True), moved], axis=2)[:, :3]


def _windows(t: Array) -> list[slice]:
    count = max(round((t[-1] - t[0]) / WINDOW), 1)
    return [
        slice(a, b) for a, b in itertools.pairwise(np.linspace(0, t.size, count + 1).astype(int))
    ]


_CREEPING = 0.002
"""Below this speed a force that has the sign of the speed fades, m/s."""

_MASSES = ("com_offset.d1", "com_offset.d2")
SIDES = ("left_right_drag.asymmetry1", "left_right_drag.asymmetry2")
_SPEEDS = np.array([0.0, 1 / 3, 2 / 3, 1.0])
"""Nodes of a wheel's force as a function of its speed, in the largest."""

_PATCHES = 6


def balance_gram(refs: Sequence[Reference], known: Known, variables: Sequence[Variable]) -> Gram:
    """Blocks `parameters`, `rolling`, `yaw`, `floor`, and the force against each variable.

    `yaw` consists of `masses` and `sides`.
    """
    everywhere = np.concatenate([ref.pose[:, :2] for ref in refs])
    corners = np.percentile(everywhere, [2, 98], axis=0)
    fastest = [float(np.percentile(np.abs(np.concatenate([ref.ports[u] for ref in refs])), 98))
               for u in ("v", "u2")]  # fmt: skip
    by = known.changes()
    parts: list[tuple[Array, int]] = []
    sizes: dict[str, int] = {}
    for ref in refs:
        own = {
            "parameters": np.einsum("nip,pq->niq", ref.by_p, by),
            "rolling": _rolling(ref, known.given, fastest),
            "yaw": _yaw(ref),
            "floor": _floor(ref, corners),
        }
        own |= {f"force by {x.name}": _along(ref, x.columns(ref)) for x in variables}
        sizes = {name: part.shape[2] for name, part in own.items()}
        parts.append(_balance_of_run(ref, np.concatenate([wiggled(ref), *own.values()], axis=2)))
    ends = np.cumsum([0, *sizes.values()])
    blocks = {name: slice(a, b) for name, a, b in zip(sizes, ends[:-1], ends[1:], strict=True)}
    yaw, masses = blocks["yaw"], blocks["yaw"].start + len(_MASSES)
    blocks |= {"masses": slice(yaw.start, masses), "sides": slice(masses, yaw.stop)}
    total = known.prior(int(ends[-1]) + 1) + sum(S for S, _ in parts)
    return Gram(total, blocks, ("parameters",), sum(count for _, count in parts))


def _balance_of_run(ref: Reference, pushes: Array) -> tuple[Array, int]:
    nb, span = ref.free.shape[1], slice(0, ref.t.size)
    moved = path_of(ref, pushes, span, held=False)[:, :3]
    left = ref.data[:, :3] - ref.pose - missed(ref, span, held=False)[:, :3]
    C = np.concatenate([moved, left[:, :, None]], axis=2) / ref.sigma[:, :3, None]
    L = start_of(ref, span, held=False)[:, :3] / ref.sigma[:, :3, None]
    seen = np.isfinite(left)
    S = products(L[seen], C[seen])
    phi = np.zeros((ref.t.size, len(S)))
    phi[:, :nb], phi[:, -1] = ref.free, ref.data[:, 3] - ref.drive[0]
    phi /= ref.sigma[:, 3, None]
    phi = phi[np.isfinite(phi).all(axis=1)]
    return eliminated(S + phi.T @ phi, nb), int(seen.sum()) + len(phi)


def _forced(ref: Reference, vdot: Array) -> Array:
    out = np.zeros((ref.t.size, 4, vdot.shape[1]))
    out[:, 3] = vdot
    return out


def _along(ref: Reference, forces: Array) -> Array:
    """A force (N) along platform 1 at its axle."""
    return _forced(ref, ref.ports["by_force1"][:, None] * forces)


def _rolling(ref: Reference, given: Mapping[str, float], fastest: Sequence[float]) -> Array:
    """At each wheel a force that is any function of its speed; drag by time; wheels' inertia."""
    parts = []
    for i, (name, most) in enumerate(zip(("v", "u2"), fastest, strict=True), 1):
        turning = ref.ports["w"] + (ref.drive[1] if i == 2 else 0.0)
        law: Array = np.zeros((ref.t.size, _SPEEDS.size))
        for side in (1, -1):
            arm = side * given[f"b{i}"]
            u = ref.ports[name] - arm * turning
            by = ref.ports[f"by_force{i}"] - arm * ref.ports["by_moment"]
            shape = np.tanh(u / _CREEPING)[:, None] * hats(np.abs(u), most * _SPEEDS)
            law += by[:, None] * shape
        parts.append(law)
    age = (ref.t - ref.t[0]) / (ref.t[-1] - ref.t[0])
    drag = ref.ports["v"] * ref.ports["by_force1"]
    parts.append(drag[:, None] * np.column_stack([age, age**2]))
    return np.concatenate(
        [_forced(ref, np.hstack(parts)), _shape(ref, ("wheel_inertia.J",))], axis=2
    )


def _yaw(ref: Reference) -> Array:
    """Masses beside the axis; left and right that differ, and a moment that is constant or as v."""
    v = ref.ports["v"]
    moments = ref.ports["by_moment"][:, None] * np.column_stack([np.ones_like(v), v])
    return np.concatenate([_shape(ref, _MASSES + SIDES), _forced(ref, moments)], axis=2)


def _floor(ref: Reference, corners: Array) -> Array:
    """Tilt and its change with place; and drag that depends on the place."""
    tilt = _shape(ref, ("floor_tilt.tilt_x", "floor_tilt.tilt_y"))
    middle, half = corners.mean(axis=0), np.maximum(np.ptp(corners, axis=0) / 2, 1e-3)
    place = (ref.pose[:, :2] - middle) / half
    bent = [tilt * place[:, k, None, None] for k in (0, 1)]
    over = [hats(place[:, k], np.linspace(-1, 1, _PATCHES)) for k in (0, 1)]
    patches = np.einsum("na,nb->nab", *over).reshape(ref.t.size, -1)
    drag = (ref.ports["v"] * ref.ports["by_force1"])[:, None]
    return np.concatenate([tilt, *bent, _forced(ref, drag * patches)], axis=2)


def _shape(ref: Reference, names: Sequence[str]) -> Array:
    """Pushes (n, 4, m) by effects of the catalogue where they vanish."""
    parameters = linearised()[0].parameters
    return ref.by_p[:, :, [parameters.index(name) for name in names]]
