"""Recordings as they were found: what was read of each, and everything that looks wrong."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from rr_opt.files.record import plain
from rr_opt.model.experiment import Flag
from rr_opt.recordings.clock_fit import ClockFit
from rr_opt.recordings.inspection import Inspection
from rr_opt.recordings.markers.pose import MarkerFit
from rr_opt.recordings.servo_clock import Synchrony
from rr_opt.recordings.time_axis import time_step
from rr_opt.report.archive import file_for_result, whole, write_text
from rr_opt.report.document import Document, Figure, captioned
from rr_opt.report.inspection_page import CAPTIONS, inspection_document, stem_of, travelled
from rr_opt.report.result import Progress, Result, quiet
from rr_opt.report.webpage import PAGE, page
from rr_opt.version import __version__


@dataclass(frozen=True, repr=False)
class InspectedRecordings(Result):
    """Recordings as they were found.

    recordings  one each, with `recording` (values, sigma and flags by channel), `doubts`, the
                markers' fit and the clock against the command
    """

    RECORD = "inspection.json"
    CAPTIONS = CAPTIONS

    name: str
    sha256: str
    recordings: tuple[Inspection, ...]

    def record(self, files: Sequence[Path] = ()) -> dict[str, Any]:
        """The content of inspection.json."""
        record = {
            "name": self.name,
            "recordings": [_recording(one) for one in self.recordings],
            "version": __version__,
            "input_sha256": self.sha256,
        }
        return plain(record)

    def document(self, figures: Sequence[Figure] = ()) -> Document:
        """Samples, noise, gaps and doubts of each recording."""
        return inspection_document(self, figures)

    def _figures(self, progress: Progress = quiet) -> tuple[Figure, ...]:
        """Of several recordings each name begins with the file's."""
        from rr_opt.report.figures.inspection import draw

        if len(self.recordings) == 1:
            return captioned(CAPTIONS, draw(self.recordings[0]))
        figures = []
        for place, one in enumerate(self.recordings, 1):
            progress(f"figures {place} of {len(self.recordings)}")
            figures += [
                replace(
                    figure,
                    name=f"{stem_of(one)}-{figure.name}",
                    title=f"{one.name}: {figure.title}",
                )
                for figure in captioned(CAPTIONS, draw(one))
            ]
        return tuple(figures)

    def _write_page(self, folder: Path, document: Document, written: Sequence[Path]) -> list[Path]:
        """The figures are in the page alone: there may be dozens."""
        return [write_text(folder / PAGE, page(document)), *written]

    def save(
        self,
        path: str | Path,
        *,
        figures: bool = True,
        progress: Progress = quiet,
        netcdf: str | Path | None = None,
    ) -> list[Path]:
        """Write inspection.json and the page; netcdf: a file for the one recording."""
        if netcdf is not None:
            file_for_result(Path(netcdf))
        written = super().save(path, figures=figures, progress=progress)
        if netcdf is not None:
            written.append(_write_netcdf(Path(netcdf), self.recordings[0]))
        return written


def _write_netcdf(path: Path, found: Inspection) -> Path:
    """Write the cleaned recording, whole. Raises InputError without the extra."""
    from rr_opt.recordings.readers.netcdf import write_netcdf

    with whole(path) as temporary:
        write_netcdf(temporary, replace(found.recording, doubts=found.doubts), found.gait)
    return path


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
