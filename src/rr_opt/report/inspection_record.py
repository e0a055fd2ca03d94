"""inspection.json: what was found in each recording, SI."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from rr_opt.model.experiment import Flag, Recording
from rr_opt.recordings.clock_fit import ClockFit
from rr_opt.recordings.inspection import Inspection
from rr_opt.recordings.markers.pose import MarkerFit
from rr_opt.recordings.servo_clock import Synchrony
from rr_opt.recordings.time_axis import time_step
from rr_opt.results.inspection import InspectedRecordings


def inspection_record(result: InspectedRecordings) -> dict[str, Any]:
    """The content of inspection.json."""
    return {"name": result.name, "recordings": [_recording(one) for one in result.recordings]}


def travelled(recording: Recording) -> dict[str, float | None]:
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
    return {"net": net, "speed": net / time if time > 0 else None, "turn": turn}


def _recording(found: Inspection) -> dict[str, Any]:
    recording, cleaned = found.recording, found.cleaned
    t = recording.t
    jumps = {
        channel: [{"t": t[jump.row], "size": jump.size} for jump in several]
        for channel, several in cleaned.jumps.items()
        if several
    }
    return {
        "file": found.name,
        "source": dict(recording.source),
        "samples": len(recording),
        "rate": 1 / time_step(t),
        "start": t[0],
        "seconds": t[-1] - t[0],
        "channels": {one: _channel(found, one) for one in recording.channels},
        "gaps": cleaned.gaps,
        "jumps": jumps,
        "path": travelled(recording),
        "gait": found.gait,
        "command": _clock(found.command),
        "servo_log": _servo_log(found.synchrony),
        "markers": _markers(found.markers),
        "doubts": list(found.doubts),
    }


def _channel(found: Inspection, channel: str) -> dict[str, Any]:
    recording, noise = found.recording, found.cleaned.noise[channel]
    flags, data = recording.flags[channel], recording.data(channel)
    some = np.isfinite(data).any()
    return {
        "low": np.nanmin(data) if some else None,
        "high": np.nanmax(data) if some else None,
        "flagged": {flag.name.lower(): (flags & flag > 0).sum() for flag in Flag if flag.name},
        "sigma": np.median(recording.sigma[channel]),
        "noise": {
            "sigma": noise.sigma,
            "sigma_error": noise.error,
            "at_half_frequency": noise.slower,
            "p_white": noise.p_white,
        },
    }


def _clock(fit: ClockFit | None) -> dict[str, Any] | None:
    return fit and {
        **{
            name: {"value": getattr(fit, name), "ci95": fit.interval(i)}
            for i, name in enumerate(("offset", "drift", "scale", "bias"))
        },
        "t_mid": fit.t_mid,
        "residual_rms": fit.residual,
    }


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
            "offset": {"value": shift.offset, "ci95": shift.interval()},
            "drift": {"value": shift.drift, "ci95": shift.interval(1)},
            "t_mid": shift.t_mid,
            "applied": shift.applied,
        },
    }


def _markers(fit: MarkerFit | None) -> dict[str, Any] | None:
    return fit and {
        "noise": fit.noise,
        "by_marker": [
            {
                "name": name,
                "platform": fit.bodies.platform[i] + 1,
                "place": fit.bodies.places[i],
                "moved": fit.shift[i],
                "residual_rms": fit.whose[i],
                "left_out": fit.ghosts.out[:, i].sum(),
            }
            for i, name in enumerate(fit.bodies.labels)
        ],
        "swaps": [
            {
                "names": [fit.bodies.labels[i] for i in swap.members],
                "frames": len(swap.frames),
                "first": fit.recording.t[swap.frames[0]],
                "last": fit.recording.t[swap.frames[-1]],
            }
            for swap in fit.swaps
        ],
        "frames_that_do_not_fit": len(fit.ghosts.lost),
    }
