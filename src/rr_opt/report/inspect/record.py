"""What was found of recordings, for scripts: SI, strict JSON."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from rr_opt.files.gait_record import gait_record
from rr_opt.model.experiment import Flag, Recording
from rr_opt.recordings.clock_fit import ClockFit
from rr_opt.recordings.inspection import Inspection
from rr_opt.recordings.markers.pose import MarkerFit
from rr_opt.recordings.noise import NoiseEstimate
from rr_opt.recordings.servo_clock import Synchrony
from rr_opt.recordings.time_axis import time_step
from rr_opt.version import __version__


def record(name: str, sha256: str, found: Sequence[Inspection]) -> dict[str, Any]:
    """The whole of `inspection.json`."""
    return {
        "name": name,
        "recordings": [_of_one(one) for one in found],
        "version": __version__,
        "input_sha256": sha256,
    }


def _of_one(found: Inspection) -> dict[str, Any]:
    recording, cleaned = found.recording, found.cleaned
    t = recording.t
    jumps = {
        channel: [{"t": float(t[jump.row]), "size": jump.size} for jump in several]
        for channel, several in cleaned.jumps.items()
        if several
    }
    return {
        "file": found.name,
        "source": dict(recording.source),
        "samples": len(recording),
        "rate": _number(1 / time_step(t)),
        "start": _number(t[0]),
        "seconds": _number(t[-1] - t[0]),
        "channels": {one: _channel(found, one) for one in recording.channels},
        "gaps": [
            {"channels": list(gap.channels), "start": gap.start, "end": gap.end,
             "samples": gap.samples}
            for gap in cleaned.gaps
        ],
        "jumps": jumps,
        "path": path_record(recording),
        "gait": gait_record(found.gait) if found.gait else None,
        "command": _clock(found.command),
        "servo_log": _servo_log(found.synchrony),
        "markers": _markers(found.markers),
        "doubts": list(found.doubts),
    }  # fmt: skip


def _channel(found: Inspection, channel: str) -> dict[str, Any]:
    recording = found.recording
    flags, data = recording.flags[channel], recording.data(channel)
    some = np.isfinite(data).any()
    return {
        "low": _number(np.nanmin(data)) if some else None,
        "high": _number(np.nanmax(data)) if some else None,
        "flagged": {flag.name.lower(): int((flags & flag > 0).sum()) for flag in Flag if flag.name},
        "sigma": _number(np.median(recording.sigma[channel])),
        "noise": _noise(found.cleaned.noise[channel]),
    }


def _noise(noise: NoiseEstimate) -> dict[str, Any]:
    return {
        "sigma": _number(noise.sigma),
        "sigma_error": _number(noise.error),
        "at_half_frequency": _number(noise.slower),
        "p_white": _number(noise.p_white),
    }


def path_record(recording: Recording) -> dict[str, Any]:
    """How far and how fast the joint went: net, m, m/s, and the turn of platform 1, rad."""
    x, y, psi = (recording.data(channel) for channel in ("x", "y", "psi"))
    both = np.flatnonzero(np.isfinite(x) & np.isfinite(y))
    headed = np.flatnonzero(np.isfinite(psi))
    if len(both) < 2:
        return {"net": None, "speed": None, "turn": None}
    first, last = both[0], both[-1]
    net = math.hypot(x[last] - x[first], y[last] - y[first])
    time = float(recording.t[last] - recording.t[first])
    turn = float(psi[headed[-1]] - psi[headed[0]]) if len(headed) else None
    return {"net": _number(net), "speed": _number(net / time) if time > 0 else None, "turn": turn}


def _clock(fit: ClockFit | None) -> dict[str, Any] | None:
    if fit is None:
        return None
    names = ("offset", "drift", "scale", "bias")
    told: dict[str, Any] = {
        name: {"value": _number(getattr(fit, name)),
               "ci95": [_number(end) for end in fit.interval(i)]}
        for i, name in enumerate(names)
    }  # fmt: skip
    return {**told, "t_mid": fit.t_mid, "residual_rms": _number(fit.residual)}


def _servo_log(found: Synchrony | None) -> dict[str, Any] | None:
    """phi against the log, the log's goal against the gait, and what the two make together."""
    if found is None:
        return None
    shift = found.shift
    return {
        "phi": _clock(found.log),
        "goal": _clock(found.goal),
        "shift": shift
        and {
            "offset": {"value": shift.offset, "ci95": list(shift.interval())},
            "drift": {"value": shift.drift, "ci95": list(shift.interval(1))},
            "t_mid": shift.t_mid,
            "applied": shift.applied,
        },
    }


def _markers(fit: MarkerFit | None) -> dict[str, Any] | None:
    if fit is None:
        return None
    return {
        "noise": _number(fit.noise),
        "by_marker": [
            {
                "name": name,
                "platform": int(fit.bodies.platform[i]) + 1,
                "place": [_number(size) for size in fit.bodies.places[i]],
                "moved": [_number(size) for size in fit.shift[i]],
                "residual_rms": _number(fit.whose[i]),
                "left_out": int(fit.ghosts.out[:, i].sum()),
            }
            for i, name in enumerate(fit.bodies.labels)
        ],
        "swaps": [
            {
                "names": [fit.bodies.labels[i] for i in swap.members],
                "frames": len(swap.frames),
                "first": float(fit.recording.t[swap.frames[0]]),
                "last": float(fit.recording.t[swap.frames[-1]]),
            }
            for swap in fit.swaps
        ],
        "frames_that_do_not_fit": len(fit.ghosts.lost),
    }


def _number(value: Any) -> float | None:
    """The value; None for what is not finite."""
    return float(value) if math.isfinite(value) else None
