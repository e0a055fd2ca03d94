"""The linear motion about a path, at given values of the parameters."""

from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np

from rr_opt.diagnose.model import Array
from rr_opt.diagnose.stages.path import Path
from rr_opt.diagnose.stages.ports import NAMES, linearised, ports, swing
from rr_opt.physics.kinematics import ROBOT_PARAMETERS


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
