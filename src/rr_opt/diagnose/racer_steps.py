"""The steps of a prediction: as long as they may be, and none across a jump of dphi."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from rr_opt.diagnose.model import Array
from rr_opt.diagnose.shoot import DrivePath
from rr_opt.physics.drive import Drive

_LONGEST, _FINE = 0.012, 0.003
"""A step is no longer, s; than the second where the wheels slip or friction is dry."""
_APART = 1e-6
"""A jump of dphi so near to an end of a step, s, is at it."""
_MOST = 3
"""Between two samples; more of them are in a gap of the recording."""


@dataclass(frozen=True)
class Steps:
    """The steps of a prediction, `each` of them between two samples, with their `edges`, s, on the
    recording's clock; `stiff` if some states settle at once."""

    edges: Array
    each: int
    stiff: bool


def steps_of(
    drive: Drive, t: Array, late: float, *, stiff: bool = False, sharp: bool = False
) -> Steps:
    """Steps between the samples t; where dphi jumps, one ends and the next begins.

    Not where states settle at once: what a jump does to those is spread over its step.
    """
    longest = _FINE if stiff or sharp else _LONGEST
    jumps = drive.jumps_within(t[0] + late, t[-1] + late) - late if not stiff else np.zeros(0)
    k = np.searchsorted(t, jumps, side="right") - 1
    inside = (jumps - t[k] > _APART) & (t[k + 1] - jumps > _APART)
    inside[1:] &= np.diff(jumps) > _APART
    jumps, k = jumps[inside], k[inside]
    few = np.arange(k.size) - np.searchsorted(k, k) < _MOST
    jumps, k = jumps[few], k[few]
    # The jumps of a sample's interval in order, and how many of them are still to come.
    order = np.arange(k.size) - np.searchsorted(k, k)
    to_come = np.searchsorted(k, k, side="right") - 1 - np.arange(k.size)
    most = int((order + to_come).max(initial=-1)) + 1
    fewest = max(float(np.median(np.diff(t))) / longest, most + 1.0)
    each = 2 ** max(math.ceil(math.log2(fewest)), 0)
    edges = t[:-1, None] + np.diff(t)[:, None] * np.arange(each) / each
    at = np.rint(each * (jumps - t[k]) / (t[k + 1] - t[k])).astype(int)
    for n in range(most):
        # Each jump takes the nearest edge that leaves the others theirs.
        this = order == n
        if n:
            before = np.flatnonzero(this) - 1
            at[this] = np.maximum(at[this], at[before] + 1)
        at[this] = np.clip(at[this], n + 1, each - 1 - to_come[this])
    edges[k, at] = jumps
    return Steps(np.append(edges.ravel(), t[-1]), each, stiff)


def drive_path(drive: Drive, steps: Steps, late: float, *, mean: bool = False) -> DrivePath:
    """The drive over the steps; `mean` takes one dphi for all of a step."""
    edges = steps.edges + late
    h = np.diff(edges)
    at_edges, middle = drive.at(edges)[:2], drive.at(edges[:-1] + h / 2)[:2]
    nodes = np.stack([at_edges[:, :-1], middle, at_edges[:, 1:]], axis=1)
    if mean or (steps.stiff and not drive.smooth):
        nodes[1] = np.diff(at_edges[0]) / h
    elif not drive.smooth:
        # Inside of the step, as dphi may jump at its ends.
        nodes[1, 0] = drive.at(edges[:-1] + _APART / 10)[1]
        nodes[1, 2] = drive.at(edges[1:] - _APART / 10)[1]
    at = at_edges[:, :: steps.each]
    if steps.stiff:
        acceleration = np.diff(at_edges[1]) / h
        nodes = np.concatenate([nodes, np.tile(acceleration, (1, 3, 1))])
        at = np.vstack([at, np.append(acceleration, acceleration[-1])[:: steps.each]])
    return DrivePath(h, nodes, at, steps.each)
