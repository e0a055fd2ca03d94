"""Do the forces balance? v follows from them here, with the measured angle as the input.

The robot has one speed, so a force along a platform and a moment on it show in the same equation,
and only their shapes tell them apart. In the mirror (phi, psi, y to -phi, -psi, -y) what resists
rolling is even, and what pulls to one side is odd: left and right wheels that differ, a mass beside
the axis. What resists may change with the time. A fault of the floor knows its place or heading.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from rr_opt.diagnose.model import Array
from rr_opt.diagnose.stages.depends import Variable
from rr_opt.diagnose.stages.gram import Gram, eliminated, products
from rr_opt.diagnose.stages.known import Known
from rr_opt.diagnose.stages.ports import linearised
from rr_opt.diagnose.stages.reference import Reference
from rr_opt.diagnose.stages.respond import missed, path_of, start_of, wiggled
from rr_opt.diagnose.stages.splines import hats

_CREEPING = 0.002
"""Below this speed a force that has the sign of the speed fades, m/s."""

_MASSES = ("com_offset.d1", "com_offset.d2")
SIDES = ("left_right_drag.asymmetry1", "left_right_drag.asymmetry2")
_SPEEDS = np.array([0.0, 1 / 3, 2 / 3, 1.0])
"""Nodes of a wheel's force as a function of its speed, in the largest."""

_PATCHES = 6


def balance_gram(
    refs: Sequence[Reference],
    known: Known,
    variables: Sequence[Variable],
) -> Gram:
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
        parts.append(_of_run(ref, np.concatenate([wiggled(ref), *own.values()], axis=2)))
    ends = np.cumsum([0, *sizes.values()])
    blocks = {name: slice(a, b) for name, a, b in zip(sizes, ends[:-1], ends[1:], strict=True)}
    yaw, masses = blocks["yaw"], blocks["yaw"].start + len(_MASSES)
    blocks |= {"masses": slice(yaw.start, masses), "sides": slice(masses, yaw.stop)}
    total = known.prior(int(ends[-1]) + 1) + sum(S for S, _ in parts)
    return Gram(total, blocks, ("parameters",), sum(count for _, count in parts))


def _of_run(ref: Reference, pushes: Array) -> tuple[Array, int]:
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
