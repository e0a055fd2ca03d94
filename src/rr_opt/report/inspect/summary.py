"""What was found of recordings, as text for a terminal."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from rr_opt.experiment.recording import Flag
from rr_opt.recordings.inspection import Inspection
from rr_opt.recordings.sizes import size_text
from rr_opt.recordings.time_step import time_step
from rr_opt.report.inspect.record import path_record
from rr_opt.report.quantities import number, with_unit
from rr_opt.report.text import columns


def summary(found: Sequence[Inspection], written: Sequence[Path]) -> str:
    """Every recording with its doubts, then the files."""
    lines: list[str] = []
    for one in found:
        lines += [*columns([(name, text) for name, text in rows(one)]), *doubt_lines(one), ""]
    lines += [f"wrote {path}" for path in written]
    return "\n".join(lines).rstrip() + "\n"


def rows(found: Inspection) -> list[tuple[str, str]]:
    """Name and text of what there is to tell of one recording."""
    recording = found.recording
    t = recording.t
    told = [
        ("recording", f"{found.name}, {recording.source.get('format', 'recording')}"),
        ("  length", f"{with_unit(float(t[-1] - t[0]), 's')} from t = "
            f"{with_unit(float(t[0]), 's')}, {len(recording)} samples at "
            f"{with_unit(1 / time_step(t), 'Hz')}"),
        ("  path", path_text(found)),
        ("  phi", _phi_text(found)),
        ("  noise", ", ".join(_noise_text(found, name) for name in recording.channels)),
        ("  flagged", flagged_text(found)),
    ]  # fmt: skip
    if found.markers is not None:
        fit = found.markers
        told.append(
            ("  markers", f"{len(fit.bodies.labels)} on two rigid platforms, which they keep to "
                f"within {1e3 * fit.noise:.3g} mm a coordinate")
        )  # fmt: skip
    if found.command is not None:
        fit = found.command
        told.append(
            ("  command", f"phi's clock {1e3 * fit.offset:+.2f} +- {1.96e3 * fit.sigma[0]:.2g} ms, "
                f"scale {fit.scale:.4f} +- {1.96 * fit.sigma[2]:.1g}, "
                f"{1e3 * fit.bias:+.2f} mrad; {1e3 * fit.residual:.3g} mrad are left")
        )  # fmt: skip
    if found.synchrony is not None and found.synchrony.shift is not None:
        shift = found.synchrony.shift
        done = "put on the command's clock" if shift.applied else "not shifted"
        told.append(
            ("  servo log", f"the command's clock is {1e3 * shift.offset:+.3f} +- "
                f"{1.96e3 * shift.sigma[0]:.2g} ms ahead of the recording's: {done}")
        )  # fmt: skip
    return told


def doubt_lines(found: Inspection) -> list[str]:
    """The doubts, a line each."""
    if not found.doubts:
        return ["  no doubts"]
    return [f"  doubt: {text}" for text in found.doubts]


def path_text(found: Inspection) -> str:
    """How far, how fast, and how much it turned."""
    path = path_record(found.recording)
    if path["net"] is None:
        return "no data"
    turned = "" if path["turn"] is None else f", turned by {math.degrees(path['turn']):+.1f} deg"
    speed = f", {1e3 * path['speed']:.1f} mm/s" if path["speed"] is not None else ""
    return f"{with_unit(path['net'], 'm')} from start to end{speed}{turned}"


def _phi_text(found: Inspection) -> str:
    phi = found.recording.data("phi")
    if not np.isfinite(phi).any():
        return "no data"
    return f"{number(float(np.nanmin(phi)))} to {number(float(np.nanmax(phi)))} rad"


def _noise_text(found: Inspection, channel: str) -> str:
    noise = found.cleaned.noise[channel]
    if not math.isfinite(noise.sigma):
        return f"{channel} ?"
    return f"{channel} {size_text(channel, noise.sigma)}"


def flagged_text(found: Inspection) -> str:
    """How many samples of which channels are not taken as data, and why."""
    recording = found.recording
    told = []
    for channel in recording.channels:
        flags = recording.flags[channel]
        counts = [
            f"{int((flags & flag > 0).sum())} {str(flag.name).lower().replace('_', ' ')}"
            for flag in Flag
            if (flags & flag).any()
        ]
        if counts:
            told.append(f"{channel}: {', '.join(counts)}")
    return "; ".join(told) or "nothing"
