"""A floor frame, a zero or a sign that is wrong, or platforms that were mistaken for each other."""

from collections.abc import Callable, Iterator, Mapping
from itertools import combinations

import numpy as np

from rr_opt.array import Array
from rr_opt.recordings.nuisances.command import follows
from rr_opt.recordings.nuisances.evidence import ExaminedRecording, Motion
from rr_opt.recordings.warnings import Notice, notice

_UNDONE: Mapping[str, Callable[[Array, Array, Array, Array], Motion]] = {
    "x and y are exchanged": lambda x, y, psi, phi: (y, x, psi, phi),
    "x is mirrored": lambda x, y, psi, phi: (-x, y, psi, phi),
    "y is mirrored": lambda x, y, psi, phi: (x, -y, psi, phi),
    "psi is off by 180 deg": lambda x, y, psi, phi: (x, y, psi + np.pi, phi),
    "psi is off by 90 deg": lambda x, y, psi, phi: (x, y, psi - np.pi / 2, phi),
    "psi is off by -90 deg": lambda x, y, psi, phi: (x, y, psi + np.pi / 2, phi),
    "psi has the other sign": lambda x, y, psi, phi: (x, y, -psi, phi),
    "phi has the other sign": lambda x, y, psi, phi: (x, y, psi, -phi),
    "phi is off by 180 deg": lambda x, y, psi, phi: (x, y, psi, phi + np.pi),
    "platforms 1 and 2 are exchanged": lambda x, y, psi, phi: (x, y, psi + phi + np.pi, -phi),
}
"""What may be wrong, and the motion as it then was.

The axes run from P towards axle 1, and from axle 2 towards P: of exchanged platforms both are the
other way round, which leaves phi without a half turn.
"""


_TOO_FAR, _NOT_FAR = 10.0, 0.05
"""Times as far sideways as a turn takes the joint, or as little, in another unit only. Wheels that
slide leave 0.7."""


def look(given: ExaminedRecording) -> Iterator[Notice]:
    """A frame, a zero or a sign that is wrong."""
    return _found(given, {name: undo(*given.motion) for name, undo in _UNDONE.items()}, units=True)


def look_twice(given: ExaminedRecording) -> Iterator[Notice]:
    """For two at once."""
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
