"""What a fault may depend on, cut into bins that overlap as hats do."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from rr_opt.diagnose.model import Array
from rr_opt.diagnose.stages.reference import Reference
from rr_opt.diagnose.stages.splines import hats

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
