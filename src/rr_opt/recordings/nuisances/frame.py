"""A frame, a zero or a sign that is wrong, platforms that were mistaken for each other, or a delay.

Each is undone on trial: rolling wheels decide whether the resulting motion is likelier.
"""

from collections.abc import Callable, Iterator, Mapping
from itertools import combinations

import numpy as np

from rr_opt.array import Array
from rr_opt.recordings.nuisances.command import follows
from rr_opt.recordings.nuisances.evidence import ROLLING, ExaminedRecording, Motion
from rr_opt.recordings.warnings import Notice, notice

_UNDONE: Mapping[str, Callable[[Array, Array, Array, Array], Motion]] = {
    "x and y are swapped": lambda x, y, psi, phi: (y, x, psi, phi),
    "x is mirrored": lambda x, y, psi, phi: (-x, y, psi, phi),
    "y is mirrored": lambda x, y, psi, phi: (x, -y, psi, phi),
    "psi is off by 180 deg": lambda x, y, psi, phi: (x, y, psi + np.pi, phi),
    "psi is off by 90 deg": lambda x, y, psi, phi: (x, y, psi - np.pi / 2, phi),
    "psi is off by -90 deg": lambda x, y, psi, phi: (x, y, psi + np.pi / 2, phi),
    "psi has the other sign": lambda x, y, psi, phi: (x, y, -psi, phi),
    "phi has the other sign": lambda x, y, psi, phi: (x, y, psi, -phi),
    "phi is off by 180 deg": lambda x, y, psi, phi: (x, y, psi, phi + np.pi),
    "platforms 1 and 2 are swapped": lambda x, y, psi, phi: (x, y, psi + phi + np.pi, -phi),
}
"""What may be wrong, and the true motion in that case.

The axes run from P towards axle 1, and from axle 2 towards P: with platforms exchanged both are
reversed, so that phi needs no half turn.
"""


_TOO_FAR, _NOT_FAR = 10.0, 0.05
"""Ratios to the joint's expected sideways motion per turn that only another unit explains. Wheels
that slide have 0.7."""


def look(given: ExaminedRecording) -> Iterator[Notice]:
    """A frame, a zero or a sign that is wrong."""
    return _found(given, {name: undo(*given.motion) for name, undo in _UNDONE.items()}, units=True)


def look_twice(given: ExaminedRecording) -> Iterator[Notice]:
    """Two of these at once."""
    return _found(
        given,
        {
            f"{one} and {two}": _UNDONE[two](*_UNDONE[one](*given.motion))
            for one, two in combinations(_UNDONE, 2)
        },
    )


def _found(
    given: ExaminedRecording, tried: Mapping[str, Motion], *, units: bool = False
) -> Iterator[Notice]:
    if given.slip.size < ROLLING:
        return
    left = {
        name: given.explains(motion) for name, motion in tried.items() if follows(given, motion[3])
    }
    ratio = given.sideways / given.robot.platform1.c if units and given.robot else 1.0
    if ratio > 0 and not _NOT_FAR < ratio < _TOO_FAR:
        x, y, psi, phi = given.motion
        meant = " (millimetres or centimetres?)" if ratio > 1 else ""
        left[f"x and y are {ratio:.3g} times too large{meant}"] = given.explains(
            (x / ratio, y / ratio, psi, phi), 1 / ratio
        )
    best = min(left.values(), default=np.inf)
    # No small fault turns phi against its command.
    wrong = given.is_wrong(best) or not follows(given, given.motion[3])
    if wrong and (meant := given.likely(left)):
        yield notice("frame.wrong", meant=", or ".join(meant), left=given.slip.size, best=best)


_PARTS = {"x and y": (0, 1), "psi": (2,), "phi": (3,)}
_FARTHEST, _TRIES = 0.25, 41
"""Longest delay of a channel, in periods or s, and number of delays that start the search."""
_SHORTEST = 0.02
"""Shortest delay reported, s: wrong lengths, or wheels that creep sideways, mimic shorter ones."""


def look_at_delays(given: ExaminedRecording) -> Iterator[Notice]:
    """Channels that are late: filtered, buffered or stamped apart from the others."""
    if given.slip.size < ROLLING:
        return
    found = {name: _best(given, columns) for name, columns in _PARTS.items()}
    likely = given.likely({name: left for name, (left, _) in found.items()})
    late = [
        f"{name} by {1e3 * found[name][1]:+.3g} ms"
        for name in likely
        if abs(found[name][1]) > _SHORTEST
    ]
    if late:
        code = "late.phi" if "phi" in likely else "late.place"
        yield notice(code, late=", or ".join(late))


def _best(given: ExaminedRecording, columns: tuple[int, ...]) -> tuple[float, float]:
    """The slip, in noise, if some channels are late, and their best delay, s."""
    most = _FARTHEST * (given.gait.period if given.gait else 1.0) / given.step

    def left(steps: float) -> float:
        return given.slip_of(_earlier(given, columns, steps * given.step)).size

    # Whole steps only: interpolation smooths the noise, which looks like a better fit.
    best, apart = 0.0, max(most, 1.0)
    while True:
        grid = np.unique(np.round(best + np.linspace(-apart, apart, _TRIES)))
        sizes = np.array([left(one) for one in grid])
        if np.diff(grid).max() <= 1:
            break
        best, apart = float(grid[int(np.argmin(sizes))]), max(1.0, np.ceil(2 * apart / _TRIES))
    at = int(np.clip(np.argmin(sizes), 1, len(grid) - 2))
    low, middle, high = sizes[at - 1 : at + 2] ** 2
    bend = low - 2 * middle + high
    late = given.step * (grid[at] + (0.5 * (low - high) / bend if bend > 0 else 0.0))
    return given.explains(_earlier(given, columns, given.step * grid[at])), float(late)


def _earlier(given: ExaminedRecording, columns: tuple[int, ...], late: float) -> Motion:
    moved = [
        _at(given.t + late, given.t, one) if column in columns else one
        for column, one in enumerate(given.motion)
    ]
    return moved[0], moved[1], moved[2], moved[3]


def _at(u: Array, t: Array, y: Array) -> Array:
    """y (n,), sampled at t, at the times u; NaN where it is not known."""
    known = np.isfinite(y)
    whole = np.interp(u, t, known.astype(float), left=0.0, right=0.0) > 0.999
    return np.where(whole, np.interp(u, t, np.where(known, y, 0.0)), np.nan)
