"""What the clocks say, in sentences."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from rr_opt.recordings.clocks.clock_fit import ClockFit
from rr_opt.recordings.warnings import Doubt

_LATE = 1e-3
"""An offset smaller than this matters to nobody, s."""
_SURE = 3.0
_RUNS_OFF = 1e-5
_LESS = 0.01
_BIASED = 2e-3
_HALF = 0.05
"""Periods."""
_TURN = 180 / np.pi


def command_doubts(
    fit: ClockFit | None, *, from_rest: bool, period: float, clock_known: bool = False
) -> tuple[Doubt, ...]:
    """Of phi against its command, whose period is in s.

    clock_known: a servo's log has told the clock's part.
    """
    if fit is None:
        return (Doubt("clock", "phi cannot be matched with its command: it does not move."),)
    if abs(abs(fit.offset) / period - 0.5) < _HALF:
        text = (
            "phi is half a period off its command, or it has the other sign. Left is positive: "
            "phi grows as platform 2 turns counter-clockwise against platform 1, seen from above."
        )
        return (Doubt("command", text),)
    return tuple(_of_command(fit, from_rest=from_rest, clock_known=clock_known))


def start_doubts(first: float, period: float) -> tuple[Doubt, ...]:
    """Of a recording that begins at a time, s, although the robot started from rest at t = 0."""
    if first < period / 4:
        return ()
    return (
        Doubt(
            "clock",
            f"The robot is said to start from rest at t = 0, and the recording begins at "
            f"t = {first:.6g} s. Is its clock the command's?",
        ),
    )


def _of_command(fit: ClockFit, *, from_rest: bool, clock_known: bool) -> Iterator[Doubt]:
    if fit.scale <= 0.1:
        yield Doubt(
            "command",
            f"phi does not follow its command: {fit.scale:.2g} of its amplitude. Another gait, "
            "degrees, or the wrong file?",
        )
        return
    if abs(fit.offset) > max(_LATE, _SURE * fit.sigma[0]):
        way = "lags" if fit.offset < 0 else "leads"
        low, high = sorted(1e3 * abs(end) for end in fit.interval(0))
        why = _why_late(fit, from_rest=from_rest, clock_known=clock_known)
        yield Doubt(
            "clock",
            f"phi {way} its command by {1e3 * abs(fit.offset):.3g} ms (95 %: {low:.3g} to "
            f"{high:.3g} ms): {why}.",
        )
    if abs(fit.drift) > max(_RUNS_OFF, _SURE * fit.sigma[1]):
        low, high = (1e6 * end for end in fit.interval(1))
        yield Doubt(
            "clock",
            f"The command's clock gains {1e6 * fit.drift:.3g} us a second on the recording's "
            f"(95 %: {low:.3g} to {high:.3g}).",
        )
    if abs(fit.scale - 1) > max(_LESS, _SURE * fit.sigma[2]):
        half = 1.96 * fit.sigma[2]
        yield Doubt(
            "command",
            f"phi moves {fit.scale:.4g} +- {half:.1g} times as far as commanded: {_why(fit.scale)}",
        )
    if abs(fit.bias) > max(_BIASED, _SURE * fit.sigma[3]):
        yield Doubt(
            "command",
            f"phi is {1e3 * fit.bias:+.3g} mrad ({_TURN * fit.bias:+.2g} deg) off its command on "
            "average: a servo mounted askew, or phi's zero.",
        )


def _why(scale: float) -> str:
    if abs(scale / _TURN - 1) < 0.2:
        return "degrees for radians?"
    if scale < 1:
        return "a lag or backlash makes it less; a clock would not."
    return "play with inertia makes it more; a clock would not."


def _why_late(fit: ClockFit, *, from_rest: bool, clock_known: bool) -> str:
    if fit.offset > 0:
        return "a clock that is off, as no servo moves before it is told"
    if clock_known:
        return "a servo that is late, as its log has told what the clocks are off by"
    both = "a servo that is late, or a clock that is off."
    if from_rest:
        return (
            f"{both} The start from rest is part of the fit, but only a model of the servo can "
            "tell one from the other"
        )
    return f"{both} This recording cannot tell one from the other: they are one thing in it"
