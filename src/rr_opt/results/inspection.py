"""Recordings as read: the data, and everything that looks wrong."""

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path, PurePath
from typing import Any

import numpy as np

from rr_opt.documents import document as doc
from rr_opt.documents.archive import file_for_result, whole
from rr_opt.formatting import counted, number, with_unit
from rr_opt.model.experiment import Flag, Recording
from rr_opt.model.machine import MachineExperiment, MachineRun
from rr_opt.recordings.clock_fit import ClockFit
from rr_opt.recordings.inspection import Inspection
from rr_opt.recordings.markers.pose import MarkerFit
from rr_opt.recordings.readers.marker_rows import carriers
from rr_opt.recordings.servo_clock import Synchrony
from rr_opt.recordings.time_axis import time_step
from rr_opt.recordings.warnings import size_text
from rr_opt.results.result import Progress, Result, picked, quiet


@dataclass(frozen=True, repr=False)
class InspectedRecordings(Result):
    """Recordings as read.

    recordings  one each, with `recording` (values, sigma and flags by channel), `doubts`, the
                markers' fit and the clock against the command
    """

    FILE = "inspection.json"
    DRAW = "rr_opt.results.figures.inspection.draw"
    CAPTIONS = doc.captions("inspection")
    # They are in the page only: there may be dozens.
    SVGS = False

    name: str
    sha256: str
    recordings: tuple[Inspection, ...]

    def save(
        self,
        path: str | Path,
        *,
        figures: bool = True,
        progress: Progress = quiet,
        netcdf: str | Path | None = None,
    ) -> list[Path]:
        """Write inspection.json and the page; netcdf: a file for the one recording."""
        if netcdf is None:
            return super().save(path, figures=figures, progress=progress)
        from rr_opt.recordings.readers.netcdf import write_netcdf

        file, found = file_for_result(Path(netcdf)), self.recordings[0]
        written = super().save(path, figures=figures, progress=progress)
        with whole(file) as temporary:
            write_netcdf(temporary, replace(found.recording, doubts=found.doubts), found.gait)
        return [*written, file]

    def drawn(self, progress: Progress = quiet) -> tuple[doc.Figure, ...]:
        """Figures; for several recordings, each name begins with the file's."""
        several, figures = len(self.recordings) > 1, []
        for place, one in enumerate(self.recordings, 1):
            progress(f"figures {place} of {len(self.recordings)}" if several else "figures")
            drawn = doc.captioned(self.CAPTIONS, self._draw(one))
            figures += _named(drawn, one.name) if several else drawn
        return tuple(figures)

    def _record(self) -> dict[str, Any]:
        return {"name": self.name, "recordings": [_recording(one) for one in self.recordings]}

    def document(self, figures: Sequence[doc.Figure] = ()) -> doc.Document:
        """Every recording with its warnings and figures."""
        found = self.recordings
        several, count = len(found) > 1, sum(len(one.doubts) for one in found)
        what = f"{len(found)} recordings" if several else "A recording"
        sections = [doc.section("Recordings", _table(found), brief=False)] if several else []
        for one in found:
            stem = PurePath(one.name).stem
            own = (f for f in figures if not several or f.name.rpartition("-")[0] == stem)
            facts = doc.facts(_facts(one))
            sections += [doc.section(one.name, facts, _warnings(one.doubts)), doc.gallery(own)]
        dropped = "Nothing was filled in or dropped."
        return _report(self.name, self.sha256, what, count, dropped, sections)


def _named(figures: Iterable[doc.Figure], recording: str) -> list[doc.Figure]:
    """Figures of one of several recordings: their names begin with its file's name."""
    stem = PurePath(recording).stem
    return [
        replace(one, name=f"{stem}-{one.name}", title=f"{recording}: {one.title}")
        for one in figures
    ]


def _warnings(doubts: Sequence[str]) -> doc.Block:
    return doc.warnings(doubts) if doubts else "No warnings."


def _report(
    name: str, sha256: str, what: str, count: int, dropped: str, sections: Iterable[doc.Section]
) -> doc.Document:
    """count: number of warnings; dropped: treatment of samples."""
    return doc.Document(
        name=name,
        kind="recordings",
        title=f"{what} with {counted(count, 'warning')}" if count else f"{what} without warnings",
        lead=f"Read each warning before using the recording. {dropped}"
        if count
        else "Nothing looks wrong in the recordings.",
        good=not count,
        sections=tuple(sections),
        footer=doc.versions(sha256),
    )


def _facts(found: Inspection) -> Iterator[doc.Fact]:
    recording = found.recording
    t = recording.t
    yield doc.Fact("format", str(recording.source.get("format", "recording")))
    length, start = with_unit(float(t[-1] - t[0]), "s"), with_unit(float(t[0]), "s")
    rate = with_unit(1 / time_step(t), "Hz")
    yield doc.Fact("length", f"{length} from t = {start}", f"{len(recording)} samples at {rate}")
    yield doc.Fact("path", _path_text(found))
    yield doc.Fact("phi", _phi_text(found))
    noise = {name: found.cleaned.noise[name].sigma for name in recording.channels}
    sizes = (f"{n} {size_text(n, s) if math.isfinite(s) else '?'}" for n, s in noise.items())
    yield doc.Fact("noise", ", ".join(sizes))
    sigma = {name: float(np.median(one)) for name, one in recording.sigma.items()}
    yield doc.Fact("sigma used", ", ".join(f"{n} {size_text(n, s)}" for n, s in sigma.items()))
    yield doc.Fact("flagged", _flagged_text(found))
    if found.markers is not None:
        fit = found.markers
        yield doc.Fact(
            "markers" if fit.bodies.lever is None else "bodies",
            f"{len(carriers(fit.bodies.labels))} on two rigid platforms, with "
            f"{1e3 * fit.noise:.3g} mm of noise per coordinate",
        )
    if found.command is not None:
        fit = found.command
        yield doc.Fact(
            "command",
            f"phi's clock {1e3 * fit.offset:+.2f} +- {1.96e3 * fit.sigma[0]:.2g} ms, "
            f"scale {fit.scale:.4f} +- {1.96 * fit.sigma[2]:.1g}, "
            f"zero {1e3 * fit.bias:+.2f} mrad; residual {1e3 * fit.residual:.3g} mrad",
        )
    if found.synchrony is not None and found.synchrony.shift is not None:
        shift = found.synchrony.shift
        yield doc.Fact(
            "servo log",
            f"the command's clock is {1e3 * shift.offset:+.3f} +- {1.96e3 * shift.sigma[0]:.2g} ms "
            "ahead of the recording's: "
            f"{'put on the command clock' if shift.applied else 'not shifted'}",
        )


def _path_text(found: Inspection) -> str:
    """Distance, speed and turn."""
    path = travelled(found.recording)
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


def _flagged_text(found: Inspection) -> str:
    """How many samples of which channels are excluded, and why."""
    texts = []
    for channel in found.recording.channels:
        flags = found.recording.flags[channel]
        counts = ((int((flags & flag > 0).sum()), flag) for flag in Flag)
        words = [f"{n} {str(flag.name).lower().replace('_', ' ')}" for n, flag in counts if n]
        if words:
            texts.append(f"{channel}: {', '.join(words)}")
    return "; ".join(texts) or "nothing"


def _table(found: Sequence[Inspection]) -> doc.Table:
    none = doc.Badge("none", "good")
    return doc.table_of(
        found,
        {
            "Recording": lambda one: one.name,
            "Samples": lambda one: str(len(one.recording)),
            "Length": lambda one: f"{one.recording.t[-1] - one.recording.t[0]:.4g} s",
            "Noise of x": lambda one: size_text("x", one.cleaned.noise["x"].sigma),
            "Noise of phi": lambda one: size_text("phi", one.cleaned.noise["phi"].sigma),
            "Warnings": lambda one: doc.Badge(f"{len(one.doubts)}", "warn") if one.doubts else none,
        },
    )


def travelled(recording: Recording) -> dict[str, float | None]:
    """Displacement and speed of the joint: net, m, m/s, and the turn of platform 1, rad."""
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
            **picked(noise, "sigma p_white"),
            "sigma_error": noise.error,
            "at_half_frequency": noise.slower,
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
    """phi against the log, the log's goal against the gait, and both combined."""
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


@dataclass(frozen=True, repr=False)
class InspectedMachine(Result):
    """The recordings of an experiment, read and cleaned; all are in `experiment.runs`."""

    FILE = "inspection.json"
    DRAW = "rr_opt.results.figures.inspection.draw_machine"
    CAPTIONS = doc.captions("machine inspection")
    SVGS = False

    experiment: MachineExperiment

    @property
    def sha256(self) -> str:
        """The fingerprint of the experiment's file and its recordings."""
        return self.experiment.sha256

    @property
    def warnings(self) -> tuple[str, ...]:
        """What looks wrong, each with its recording's name."""
        return tuple(f"{run.name}: {doubt}" for run in self.experiment.runs for doubt in run.doubts)

    def drawn(self, progress: Progress = quiet) -> tuple[doc.Figure, ...]:
        """The channels of each recording."""
        figures = []
        for run in self.experiment.runs:
            progress(f"figure of {run.name}")
            drawn = self._draw((self.experiment.machine, run))
            figures += _named(doc.captioned(self.CAPTIONS, drawn), run.name)
        return tuple(figures)

    def _record(self) -> dict[str, Any]:
        return {
            "name": self.experiment.name,
            "machine": self.experiment.machine.name,
            "recordings": [self._recording(run) for run in self.experiment.runs],
        }

    def _recording(self, run: MachineRun) -> dict[str, Any]:
        return {
            "file": run.name,
            "use": "holdout" if run.held_out else "fit",
            "samples": len(run),
            "rate": _rate(run),
            "seconds": run.t[-1] - run.t[0],
            "channels": {
                name: {
                    "low": np.nanmin(y),
                    "high": np.nanmax(y),
                    "missing": int(np.isnan(y).sum()),
                    "sigma": run.sigma[name],
                }
                for name, y in _data(run).items()
            },
            "doubts": run.doubts,
        }

    def document(self, figures: Sequence[doc.Figure] = ()) -> doc.Document:
        """Every recording with its channels and warnings."""
        experiment, count = self.experiment, len(self.warnings)
        sections = [doc.section(run.name, *self._blocks(run)) for run in experiment.runs]
        what = f"{counted(len(experiment.runs), 'recording')} of {experiment.machine.words}"
        sections.append(doc.gallery(figures))
        dropped = "Outliers were dropped."
        report = _report(experiment.name, self.sha256, what, count, dropped, sections)
        return replace(report, machine=experiment.machine.name.capitalize())

    def _blocks(self, run: MachineRun) -> list[doc.Block]:
        length = f"{with_unit(float(run.t[-1]), 's')}, {len(run)} samples at "
        facts = doc.Facts((doc.Fact("length", length + with_unit(_rate(run), "Hz")),))
        data = _data(run)
        channels = doc.table_of(
            [one for one in self.experiment.machine.channels if one.name in data],
            {
                "Channel": lambda c: f"{c.words} ({c.name})",
                "From": lambda c: with_unit(float(np.nanmin(data[c.name])), c.unit, 3),
                "To": lambda c: with_unit(float(np.nanmax(data[c.name])), c.unit, 3),
                "Noise": lambda c: (
                    with_unit(run.sigma[c.name], c.unit, 2) if run.sigma[c.name] else "exact"
                ),
                "Missing": lambda c: str(int(np.isnan(data[c.name]).sum())),
            },
        )
        return [facts, channels, _warnings(run.doubts)]


def _data(run: MachineRun) -> Mapping[str, np.ndarray]:
    return {**run.inputs, **run.outputs}


def _rate(run: MachineRun) -> float:
    return 1 / float(np.median(np.diff(run.t)))
