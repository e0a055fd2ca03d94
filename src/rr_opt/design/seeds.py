"""Starts for multiple shooting: scan the whole box coarsely, climb from every promising point.

Starts for a turn: gaits that turn as asked are looked for first, then climbed from.

They are a thin layer of the box, which points all over it miss. So along lines of offsets the
places are sought where a row crosses the end of its interval. Climbs from there weigh the turn
twice: lightly, as a strict weight makes of the layer a ridge along which climbers hardly move,
and strictly, as with a light one they would rather go fast beside the turn.
"""

from __future__ import annotations

import math
from functools import partial

import numpy as np
from numpy.typing import NDArray

from rr_opt.array import Array
from rr_opt.design.climb import Merit, climb
from rr_opt.design.decisions import Decisions, TurnRows
from rr_opt.design.landscape import Cycles, Landscape
from rr_opt.design.scan import (
    CLIMBERS,
    FINER_NODES,
    NODES,
    POINTS,
    PROMISING,
    ROUGH,
    THOROUGH,
    Seed,
    peaks,
    scan,
    search,
    share_of,
)
from rr_opt.model.problem import Interval

_LIGHT, _STRICT = 3.0, 30.0
"""Penalties for an excess of 1, in the largest speed there is."""
_LINE, _BISECTIONS = 17, 5
_UNSETTLED = 10.0
_MORE = 2
"""So many times as many climbers as without a turn."""
_WORTH_SOLVING, _MOST = 0.5, 8
_OFF, _ON = 0.05, 2e-3
"""Excess beyond which a top is on no way to a gait that turns as asked, and up to which it is
one."""


def turn_seeds(
    landscape: Landscape,
    decisions: Decisions,
    rows: TurnRows,
    torque_limit: float,
    signs: tuple[int, ...],
) -> tuple[list[Seed], float]:
    """Starts, best first, and what the best is worth, m/s."""

    def terrain(points: Array, sign: Array, nodes: int = NODES) -> Array:
        gaits = decisions.physical(points)
        cycles = landscape.cycles(gaits, nodes)
        turn = rows.values(cycles.speed, cycles.turn, gaits[1])
        values = np.array([sign * cycles.speed, cycles.peak_torque / torque_limit, *turn])
        values[1, ~np.isfinite(values).all(axis=0)] = _UNSETTLED
        return np.where(np.isfinite(values), values, 0.0)

    def finer(points: Array, sign: Array) -> Array:
        return terrain(points, sign, FINER_NODES)

    free, asked = decisions.free, rows.intervals
    kept = (Interval(-math.inf, 1.0), *asked)
    points = scan(decisions, POINTS[len(free)])
    points = np.concatenate([points, _crossings(points, decisions, asked, terrain)])
    seen = terrain(points, np.ones(len(points)))
    light, strict = _merits(kept, seen)
    candidates, most = np.concatenate([points for _ in signs]), _MORE * CLIMBERS[len(free)]
    sign = np.repeat(signs, len(points))
    signed = np.concatenate([np.array([way * seen[0], *seen[1:]]) for way in signs], axis=1)
    rough = []
    for merit in (light, strict):
        chosen = peaks(candidates[:, free], sign, merit(signed), most, -math.inf)
        start, ways = candidates[chosen], sign[chosen]
        rough.append(climb(start, ways, free, terrain, merit, ROUGH)[:2])
    tops, ways = (np.concatenate(part) for part in zip(*rough, strict=True))
    tops, ways, values = climb(tops, ways, free, finer, strict, THOROUGH)
    seen = finer(tops, ways)
    excess = _excess(kept, seen)
    # From where no gait turns as asked the solver goes a long way to find none either. But what
    # is fast beside the turn may be on no way to it, so the fastest on it are taken as well.
    good = {i: None for off in (_OFF, _ON) for i in _fastest(seen[0], excess <= off)} or {0: None}
    return [Seed(int(ways[i]), tops[i]) for i in good], float(values[0])


def _fastest(speed: Array, near: NDArray[np.bool_]) -> list[int]:
    """Indices of those that are near and at least half as fast as the fastest of them."""
    least = share_of(speed[near].max(initial=-math.inf), _WORTH_SOLVING)
    return np.flatnonzero(near & (speed >= least))[:_MOST].tolist()


def _merits(kept: tuple[Interval, ...], seen: Array) -> tuple[Merit, Merit]:
    """The light and the strict merit. Their unit is the largest speed of gaits that turn nearly as
    asked: others can be a hundred times as fast, and would drown what is to be told apart."""
    near = _excess(kept, seen) <= _OFF
    unit = float(np.abs(seen[0, near] if near.any() else seen[0]).max())
    light, strict = (
        Merit(kept, (_LIGHT * unit, *(weight * unit for _ in kept[1:])))
        for weight in (_LIGHT, _STRICT)
    )
    return light, strict


def _excess(kept: tuple[Interval, ...], seen: Array) -> Array:
    """How far torque and turn are outside their intervals, all together."""
    return -Merit(kept, (1.0,) * len(kept))(np.array([np.zeros_like(seen[0]), *seen[1:]]))


def _crossings(points: Array, decisions: Decisions, asked: tuple[Interval, ...], terrain) -> Array:
    """Points where a row comes to an end of its interval, on lines through these points."""
    along = next((i for i in (1, 2, 0, 3) if i in decisions.free), None)
    if along is None:
        return np.empty((0, 4))
    lines = np.repeat(points[:, None], _LINE, axis=1)
    lines[:, :, along] = np.linspace(0.0, 1.0, _LINE)
    flat = lines.reshape(-1, 4)
    seen = terrain(flat, np.ones(len(flat)))[2:].reshape(len(asked), len(points), _LINE)
    found = []
    for row, (values, interval) in enumerate(zip(seen, asked, strict=True)):
        for end in {interval.low, interval.high}:
            if not math.isfinite(end):
                continue
            above = values > end
            line, left = np.nonzero(above[:, 1:] != above[:, :-1])
            low, high = lines[line, left], lines[line, left + 1]
            rising = above[line, left + 1]
            for _ in range(_BISECTIONS if len(line) else 0):
                middle = (low + high) / 2
                beyond = terrain(middle, np.ones(len(middle)))[2 + row] > end
                upper = (beyond == rising)[:, None]
                low, high = np.where(upper, low, middle), np.where(upper, middle, high)
            found.append((low + high) / 2)
    return np.concatenate(found) if found else np.empty((0, 4))


# A top this much slower than the best is not solved from.
_SEEDS_WORTH_SOLVING = 0.5
_FEW = 2
# What a gait counts as using of the torque limit that has no steady cycle.
_SEEDS_UNSETTLED = 10.0
_WITHIN = (Interval(-np.inf, 1.0),)


def find_seeds(
    landscape: Landscape, decisions: Decisions, torque_limit: float, signs: tuple[int, ...]
) -> tuple[list[Seed], float]:
    """Starts that are each in a basin of their own as far as the scan can tell, best first, and
    the speed of the best, m/s: negative if it goes against its direction."""
    if decisions.turn:
        return turn_seeds(landscape, decisions, decisions.turn, torque_limit, signs)

    def terrain(points: Array, sign: Array, nodes: int = NODES) -> Array:
        cycles = landscape.cycles(decisions.physical(points), nodes)
        speed, torque = sign * cycles.speed, cycles.peak_torque / torque_limit
        settled = np.isfinite(speed) & np.isfinite(torque)
        return np.array(
            [np.where(settled, speed, 0.0), np.where(settled, torque, _SEEDS_UNSETTLED)]
        )

    free = decisions.free
    points = scan(decisions, POINTS[len(free)])
    seen = terrain(points, np.ones(len(points)))
    merit = Merit(_WITHIN, (3 * float(np.abs(seen[0]).max()),))
    candidates = np.concatenate([points for _ in signs])
    sign = np.repeat(signs, len(points))
    values = np.concatenate([merit(np.array([way * seen[0], seen[1]])) for way in signs])
    least = share_of(values.max(), PROMISING)
    chosen = peaks(candidates[:, free], sign, values, CLIMBERS[len(free)], least)
    tops, sign, values = climb(candidates[chosen], sign[chosen], free, terrain, merit, ROUGH)
    worth = values >= share_of(values[0], _SEEDS_WORTH_SOLVING)
    tops, sign = tops[worth], sign[worth]
    if decisions.mirrored:
        tops[:, 1] = np.maximum(tops[:, 1], 1 - tops[:, 1])
    # A few tops are solved from sooner than told apart.
    if len(tops) > _FEW:
        finer = partial(terrain, nodes=FINER_NODES)
        tops, sign, values = climb(tops, sign, free, finer, merit, THOROUGH)
    good = np.flatnonzero(values >= share_of(values[0], _SEEDS_WORTH_SOLVING))
    return [Seed(int(sign[i]), tops[i]) for i in good], float(values[0])


def least_torque(landscape: Landscape, decisions: Decisions) -> float:
    """The smallest peak torque of any gait of the box, N m."""

    def look(cycles: Cycles, _gaits: Array, _sign: Array) -> Array:
        return -cycles.peak_torque[None]

    return -search(landscape, decisions, look, Merit((), ()), (1,))[2]
