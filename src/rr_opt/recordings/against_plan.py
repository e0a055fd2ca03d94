"""Whether a recording can be what the experiment file says of it: its units, and its gait.

Nothing is put right: the experimenter has to say. A fault of the robot is none of these: a servo
that lags, slips behind or has play makes an angle of the command's period, near its size and time.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from rr_opt.array import Array
from rr_opt.model.experiment import CHANNELS, Run
from rr_opt.model.gait import Gait
from rr_opt.model.robot import Robot
from rr_opt.recordings.warnings import Doubt

_LENGTHS = 5.0
"""No robot drives so many of its own lengths in a period."""
_HEADING = 6.0
"""Nor does its heading swing so many times as far as phi: in degrees it is 57 times too far."""
_SIZE = 20.0
"""Times as far as told, or as little, phi moves in another unit only."""
_ALIKE = 0.5
"""Of phi's variance that is the gait's where that was driven."""
_OTHER = 0.8
"""The same of a sine of another period, where that was driven."""
_LATE, _HALF = 0.3, 0.45
"""Of a period; a servo that lags stays below a quarter, and the other sign is half of one."""
HALF_A_PERIOD = "half a period"
"""The kind of doubt about phi that may have the other sign: of one recording, or of all."""
_FAR = 1.3
"""Times as far as commanded, or as little, phi moves with a grave fault, or another command."""
_SHIFTS = 64
_TOO_FAR, _NOT_FAR = 10.0, 0.05
"""Times as far sideways as a turn takes the joint, or as little, in another unit only. Wheels that
slide leave 0.7."""
_WITH, _STRIDE = 0.7, 5
"""Correlation of the angles' steps, over so many samples, from which on they turn together."""


def plan_doubts(run: Run, robot: Robot) -> tuple[Doubt, ...]:
    """Why a recording that moves is not of this robot and this gait, in these units.

    Doubts of the kinds `units` and `command` leave nothing to fit; nor do those of the kind
    HALF_A_PERIOD if all recordings have them. Those of the kind `doubtful` may be a fault of the
    robot after all.
    """
    t, period = run.recording.t, run.gait.period
    sizes = {name: _swing(t, run.recording.data(name), period) for name in CHANNELS}
    psi, phi = run.recording.data("psi"), run.recording.data("phi")
    length = robot.platform1.c + robot.platform2.c
    x, y = run.recording.data("x"), run.recording.data("y")
    return (
        *_command(t, phi, run.gait),
        *(_units(sizes, length) or _sideways(x, y, psi, robot.platform1.c)),
        *_signs(psi, phi),
    )


def _units(sizes: dict[str, float], length: float) -> tuple[Doubt, ...]:
    doubts = []
    if (driven := max(sizes["x"], sizes["y"])) > _LENGTHS * length:
        doubts.append(
            f"The joint moves {driven:.4g} in a period, and the robot is {length:.3g} m long. "
            "Expected metres: are these millimetres or centimetres?"
        )
    if sizes["psi"] > _HEADING * sizes["phi"] > 0:
        doubts.append(
            f"The heading turns by {sizes['psi']:.4g} in a period, and phi by {sizes['phi']:.3g}. "
            "Expected radians for both: is psi in degrees?"
        )
    return tuple(Doubt("units", text) for text in doubts)


def _sideways(x: Array, y: Array, psi: Array, c: float) -> Iterator[Doubt]:
    """A turn of platform 1 about its axle takes the joint c sideways; wheels that slip, less."""
    dx, dy, turned = (values[_STRIDE:] - values[:-_STRIDE] for values in (x, y, psi))
    heading = (psi[_STRIDE:] + psi[:-_STRIDE]) / 2
    side = np.cos(heading) * dy - np.sin(heading) * dx
    known = np.isfinite(side) & np.isfinite(turned)
    turned, side = turned[known], side[known]
    swings = float(turned @ turned)
    ratio = abs(float(side @ turned)) / (c * swings) if swings > 0 and c > 0 else 0.0
    if ratio > _TOO_FAR or 0 < ratio < _NOT_FAR:
        unit = "millimetres or centimetres" if ratio > 1 else "another unit"
        yield Doubt(
            "units",
            f"The joint moves sideways {ratio:.3g} times as far as the turns of platform 1 take "
            f"it. Expected metres: are these {unit}?",
        )


def _signs(psi: Array, phi: Array) -> Iterator[Doubt]:
    # The platforms turn against each other, whether the wheels hold or slip.
    one, two = (values[_STRIDE:] - values[:-_STRIDE] for values in (psi, phi))
    known = np.isfinite(one) & np.isfinite(two)
    if np.corrcoef(one[known], two[known])[0, 1] > _WITH:
        yield Doubt(
            "units",
            "The heading swings with phi. Expected it to swing against phi: both are positive "
            "counter-clockwise, seen from above. Correct the sign of one of them.",
        )


def _command(t: Array, phi: Array, gait: Gait) -> Iterator[Doubt]:
    known = np.isfinite(phi)
    t, phi = t[known], phi[known]
    told = float(np.ptp(gait.angle(np.linspace(0, gait.period, 200))))
    if not told > 0:
        return
    moved = _swing(t, phi, gait.period)
    if moved > _SIZE * told or _SIZE * moved < told:
        yield Doubt(
            "units",
            f"phi ranges over {moved:.3g} in a period, and the gait over {told:.3g} rad. Expected "
            "about the same: is one of them in degrees, or did the servo not follow?",
        )
        return
    shifts = gait.period * (np.arange(_SHIFTS) / _SHIFTS - 0.5)
    alike = [float(np.corrcoef(phi, gait.angle(t + shift))[0, 1]) for shift in shifts]
    best = int(np.argmax(alike))
    if alike[best] ** 2 < _ALIKE:
        period, share = _period(t, phi)
        if share > _OTHER:
            yield Doubt(
                "command",
                f"phi repeats every {period:.3g} s, and the gait every {gait.period:.3g} s. "
                "Expected the gait that was driven. Correct `gait`, or name the right file.",
            )
        return
    if abs(shifts[best]) > _LATE * gait.period:
        yield Doubt(
            HALF_A_PERIOD if abs(shifts[best]) > _HALF * gait.period else "doubtful",
            f"phi is {abs(shifts[best]):.2g} s off its command, of a period of "
            f"{gait.period:.3g} s. Is t = 0 where the command begins, and phi positive to the "
            "left?",
        )
    if not 1 / _FAR < moved / told < _FAR:
        yield Doubt(
            "doubtful",
            f"phi moves {moved / told:.2g} times as far as commanded. Is `amplitude` the one that "
            "was driven?",
        )


def _period(t: Array, phi: Array) -> tuple[float, float]:
    """The period of the sine that explains most of phi, and how much of its variance that is."""
    span = float(t[-1] - t[0])
    step = float(np.median(np.diff(t)))
    rates = np.arange(1.0, min(span / (4 * step), 60 * span), 0.25) / span
    shares = []
    for rate in rates:
        turn = 2 * np.pi * rate * t
        shares.append(_explained(phi, [np.sin(turn), np.cos(turn)]))
    best = int(np.argmax(shares))
    return 1 / float(rates[best]), shares[best]


def _explained(y: Array, columns: list[Array]) -> float:
    """Of y's variance, what a constant and multiples of the columns explain."""
    A = np.column_stack([np.ones(len(y)), *columns])
    left = y - A @ np.linalg.lstsq(A, y, rcond=None)[0]
    return 1 - float(left @ left) / max(len(y) * float(np.var(y)), 1e-300)


def _swing(t: Array, y: Array, period: float) -> float:
    """How far y ranges within a period, the median over the recording; outliers left out."""
    pieces = np.floor((t - t[0]) / period).astype(int)
    ranges = []
    for piece in range(pieces[-1] + 1):
        inside = y[(pieces == piece) & np.isfinite(y)]
        if len(inside) > 3:
            low, high = np.percentile(inside, (2, 98))
            ranges.append(high - low)
    return float(np.median(ranges)) if ranges else 0.0
