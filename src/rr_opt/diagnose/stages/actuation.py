"""Does the measured angle follow its command? The channel phi alone; no dynamics, no geometry.

Its residual is white noise where nothing is wrong. A clock that is off moves the command as a whole
and leaves nothing; a servo that is slow, limited, loose or off does not, as its swing changes too.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from rr_opt.diagnose.diagnosis import Curve
from rr_opt.diagnose.model import Array
from rr_opt.diagnose.racer import RollerRacer
from rr_opt.diagnose.stages.gram import Worth
from rr_opt.diagnose.stages.reference import Reference
from rr_opt.physics.drive import told

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
    command = told(here.gait, here.start == "rest").at(ref.t + offset)
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
