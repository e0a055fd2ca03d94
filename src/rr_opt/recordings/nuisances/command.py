"""An angle that is not that of its command: another gait, unit or sign, or a clock that is off."""

from collections.abc import Iterator

import numpy as np

from rr_opt.array import Array
from rr_opt.recordings.clock_fit import RUNS_OFF, ClockFit
from rr_opt.recordings.nuisances.clock import dominant
from rr_opt.recordings.nuisances.evidence import ExaminedRecording
from rr_opt.recordings.warnings import Notice, notice

_ALIKE, _OTHER = 0.5, 0.8
"""Of phi's variance, what is the gait's where it was driven, and a sine's of another period."""
_SIZE = 20.0
"""Times as far as commanded, or as little, phi moves in another unit only."""
_LATE = 1e-3
"""An offset smaller than this matters to nobody, s."""
_SURE = 3.0
_LESS = 0.01
_BIASED = 2e-3
_HALF = 0.05
"""Periods."""


def look(given: ExaminedRecording) -> Iterator[Notice]:
    """An angle that does not follow its command, or not at once."""
    if given.gait is None:
        return
    fit, period = given.command, given.gait.period
    if fit is None:
        yield notice("command.still")
    elif fit.residual**2 > (1 - _ALIKE) * float(np.nanvar(given.motion[3])):
        seen, share = dominant(given.t, given.motion[3])
        if share > _OTHER and abs(seen / period - 1) > _HALF:
            yield notice("command.period", period=seen, commanded=period)
        else:
            yield notice("command.other", scale=fit.scale)
    elif not 1 / _SIZE < abs(fit.scale) < _SIZE:
        yield notice("units.phi", times=fit.scale)
    elif abs(abs(fit.offset) / period - 0.5) < _HALF:
        yield notice("command.half", late=abs(fit.offset), period=period)
    else:
        yield from _details(given, fit)


def _details(given: ExaminedRecording, fit: ClockFit) -> Iterator[Notice]:
    if abs(fit.offset) > max(_LATE, _SURE * fit.sigma[0]):
        low, high = sorted(1e3 * abs(end) for end in fit.interval(0))
        way, size = "lags" if fit.offset < 0 else "leads", 1e3 * abs(fit.offset)
        yield notice("clock.offset", way=way, size=size, low=low, high=high, why=_late(given, fit))
    if abs(fit.drift) > max(RUNS_OFF, _SURE * fit.sigma[1]):
        low, high = (1e6 * end for end in fit.interval(1))
        yield notice("clock.drift", drift=1e6 * fit.drift, low=low, high=high)
    if abs(fit.scale - 1) > max(_LESS, _SURE * fit.sigma[2]):
        half, why = 1.96 * fit.sigma[2], _scale(fit.scale)
        yield notice("command.scale", scale=fit.scale, half=half, why=why)
    if abs(fit.bias) > max(_BIASED, _SURE * fit.sigma[3]):
        yield notice("command.bias", bias=1e3 * fit.bias, degrees=np.degrees(fit.bias))


def _scale(scale: float) -> str:
    if scale < 1:
        return "a lag or backlash makes it less; a clock would not."
    return "play with inertia makes it more; a clock would not."


def _late(given: ExaminedRecording, fit: ClockFit) -> str:
    if fit.offset > 0:
        return "a clock that is off, as no servo moves before its command"
    if given.clock_known:
        return "a servo that is late, as its log gives the offset of the clocks"
    both = "a servo that is late, or a clock that is off."
    if given.start == "rest":
        return (
            f"{both} The start from rest is part of the fit, but only a model of the servo can "
            "distinguish the two"
        )
    return f"{both} This recording cannot distinguish the two: they have the same effect"


def follows(given: ExaminedRecording, phi: Array) -> bool:
    """Whether an angle (n,) is less than a quarter of a period off its command, if that shows."""
    if given.gait is None:
        return True
    known = np.isfinite(phi)
    command = given.gait.angle(given.t[known])
    alike = float(np.corrcoef(phi[known], command)[0, 1])
    return not alike < -_ALIKE
