"""How pushes at the ports move the path: the linear motion about a reference, by quadratures.

The robot without slip is a chain: v follows from forces, the heading from v, the place from both.
So nothing has to be stepped: z is one integral with an integrating factor, psi and x, y are plain
integrals, over all columns at once.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from rr_opt.array import Array
from rr_opt.machines.racer.stages.reference import Reference, integral


@dataclass(frozen=True)
class Push:
    """What is added to the rates of x, y, psi and z: (n, 4, m) per unit of each of m unknowns."""

    rates: Array

    def __add__(self, other: Push) -> Push:
        return Push(np.concatenate([self.rates, other.rates], axis=2))


def path_of(ref: Reference, pushes: Array, span: slice, *, held: bool) -> Array:
    """Displacements (n, 4, m) of x, y, psi, z by pushes (n, 4, m) within a span, from no start.

    held: z is not moved by forces at all, but given: pushes of z are z itself.
    """
    t = ref.t[span]
    A = ref.by_state[span]
    out = np.empty((t.size, 4, pushes.shape[2]))
    z = pushes[:, 3] if held else _driven(t, A[:, 3, 3], pushes[:, 3])
    psi = integral(t, pushes[:, 2] + A[:, 2, 3, None] * z)
    turned = np.stack([A[:, k, 2, None] * psi + A[:, k, 3, None] * z for k in (0, 1)], axis=1)
    out[:, :2] = integral(t, pushes[:, :2] + turned)
    out[:, 2], out[:, 3] = psi, z
    return out


def start_of(ref: Reference, span: slice, *, held: bool) -> Array:
    """Displacements (n, 4, 3 or 4) by x, y, psi and, unless it is held, z at the start."""
    t, A = ref.t[span], ref.by_state[span]
    out = np.zeros((t.size, 4, 3 if held else 4))
    out[:, [0, 1, 2], [0, 1, 2]] = 1.0
    out[:, :2, 2] = integral(t, A[:, :2, 2])
    if not held:
        z = _growth(t, A[:, 3, 3])
        push = np.zeros((t.size, 4, 1))
        push[:, 3, 0] = z
        out[:, :, 3] = path_of(ref, push, span, held=True)[:, :, 0]
    return out


def missed(ref: Reference, span: slice, *, held: bool) -> Array:
    """Displacement (n, 4) from the reference to the path that obeys the equations."""
    t, A = ref.t[span], ref.by_state[span]
    D = ref.missed[span] - ref.missed[span][0]
    z = np.zeros(t.size) if held else -D[:, 3] + _driven(t, A[:, 3, 3], -A[:, 3, 3] * D[:, 3])
    psi = -D[:, 2] + integral(t, A[:, 2, 3] * z)
    out = np.column_stack([D[:, 0], D[:, 1], psi, z])
    for k in (0, 1):
        out[:, k] = -D[:, k] + integral(t, A[:, k, 2] * psi + A[:, k, 3] * z)
    return out


def wiggled(ref: Reference) -> Array:
    """Pushes (n, 4, nb) by the deviations of the angle that are free."""
    return np.einsum("nij,jnb->nib", ref.by_drive, np.array([ref.free, ref.free_rate]))


def _growth(t: Array, a: Array) -> Array:
    return np.exp(integral(t, a))


def _driven(t: Array, a: Array, force: Array) -> Array:
    """dz/dt = a z + force from z = 0; a (n,) is negative but for moments."""
    growth = _growth(t, a)
    growth = growth[:, None] if force.ndim > 1 else growth
    return growth * integral(t, force / growth)
