"""What the clocks say, in sentences: a lag, a drift, a servo that moves less than it was told."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from rr_opt.recordings.clock_fit import ClockFit
from rr_opt.recordings.doubts import Doubt

_LATE = 1e-3
"""An offset smaller than this matters to nobody, s."""
_SURE = 3.0
_RUNS_OFF = 1e-5
_LESS = 0.01
_BIASED = 2e-3
_TURN = 180 / np.pi


def command_doubts(fit: ClockFit | None, *, from_rest: bool) -> tuple[Doubt, ...]:
    """Of phi against its command."""
    if fit is None:
        return (Doubt("clock", "phi cannot be matched with its command: it does not move."),)
    return tuple(_of_command(fit, from_rest=from_rest))


def _of_command(fit: ClockFit, *, from_rest: bool) -> Iterator[Doubt]:
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
        why = (
            "a clock that is off, as no servo moves before it is told"
            if fit.offset > 0
            else "a servo that is late, or a clock that is off. The start from rest is part of the "
            "fit, but only a model of the servo can tell one from the other"
            if from_rest
            else "a servo that is late, or a clock that is off. This recording cannot tell one "
            "from the other: they are one thing in it"
        )
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


def log_doubts(
    fit: ClockFit | None, others: tuple[float, ...], period: float | None = None
) -> tuple[Doubt, ...]:
    """Of the capture's clock against the servo's."""
    if fit is None:
        return (Doubt("clock", "The servo's log and phi have no motion in common."),)
    low, high = fit.interval(0)
    told = [
        Doubt(
            "log",
            f"The servo's clock is {fit.offset:+.4f} s against the capture's (95 %: {low:+.4f} to "
            f"{high:+.4f} s), and gains {1e6 * fit.drift:+.3g} +- {1.96e6 * fit.sigma[1]:.2g} us a "
            "second. A delay within the servo or the capture is part of it: they are one thing.",
        )
    ]
    if others:
        whole = f", or whole periods of {period:.4g} s off" if period else ""
        also = ", ".join(f"{other:+.3f}" for other in others[:3])
        told.append(
            Doubt(
                "log",
                f"The motion repeats itself, and fits about as well with {also} s{whole}. Start "
                "both recordings before the command.",
            )
        )
    if abs(fit.scale - 1) > max(_LESS, _SURE * fit.sigma[2]):
        told.append(
            Doubt(
                "log",
                f"phi moves {fit.scale:.4g} times as far as the servo's log has it: its count "
                "scale, or a joint that gives?",
            )
        )
    return tuple(told)
