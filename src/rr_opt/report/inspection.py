"""The report of recordings that were inspected."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import Path, PurePath
from typing import Any

import numpy as np

from rr_opt.documents import document as doc
from rr_opt.documents.archive import file_for_result, whole
from rr_opt.documents.report import Progress, Report, quiet
from rr_opt.documents.texts import captions
from rr_opt.formatting import counted, number, with_unit
from rr_opt.model.experiment import Flag
from rr_opt.recordings.inspection import Inspection
from rr_opt.recordings.time_axis import time_step
from rr_opt.recordings.warnings import size_text
from rr_opt.report.inspection_record import inspection_record, travelled
from rr_opt.results.inspection import InspectedRecordings


def inspection_document(
    result: InspectedRecordings, figures: Sequence[doc.Figure] = ()
) -> doc.Document:
    """Every recording with its warnings and figures."""
    found = result.recordings
    several, count = len(found) > 1, sum(len(one.doubts) for one in found)
    what = f"{len(found)} recordings" if several else "A recording"
    sections = [doc.Section("Recordings", (_table(found),), brief=False)] if several else []
    for one in found:
        doubts = doc.warnings(one.doubts) if one.doubts else "No warnings."
        own = (f for f in figures if not several or f.name.rpartition("-")[0] == stem_of(one))
        sections.append(doc.Section(one.name, (doc.Facts(tuple(_facts(one))), doubts)))
        sections.append(doc.gallery(own))
    return doc.Document(
        name=result.name,
        kind="recordings",
        title=f"{what} with {counted(count, 'warning')}" if count else f"{what} without warnings",
        lead="Read each warning before using the recording. Nothing was filled in or dropped."
        if count
        else "Nothing looks wrong in the recordings.",
        good=not count,
        sections=tuple(sections),
        footer=doc.versions(result.sha256),
    )


def stem_of(one: Inspection) -> str:
    """The name of a recording's file, without its ending."""
    return PurePath(one.name).stem


def _facts(found: Inspection) -> Iterator[doc.Fact]:
    recording = found.recording
    t = recording.t
    yield doc.Fact("format", str(recording.source.get("format", "recording")))
    length, start = with_unit(float(t[-1] - t[0]), "s"), with_unit(float(t[0]), "s")
    rate = with_unit(1 / time_step(t), "Hz")
    yield doc.Fact("length", f"{length} from t = {start}", f"{len(recording)} samples at {rate}")
    yield doc.Fact("path", _path_text(found))
    yield doc.Fact("phi", _phi_text(found))
    yield doc.Fact("noise", ", ".join(_noise_text(found, name) for name in recording.channels))
    sigma = {name: float(np.median(one)) for name, one in recording.sigma.items()}
    yield doc.Fact("sigma used", ", ".join(f"{n} {size_text(n, s)}" for n, s in sigma.items()))
    yield doc.Fact("flagged", _flagged_text(found))
    if found.markers is not None:
        fit = found.markers
        yield doc.Fact(
            "markers",
            f"{len(fit.bodies.labels)} on two rigid platforms, with {1e3 * fit.noise:.3g} mm of "
            "noise per coordinate",
        )
    if found.command is not None:
        fit = found.command
        yield doc.Fact(
            "command",
            f"phi's clock {1e3 * fit.offset:+.2f} +- {1.96e3 * fit.sigma[0]:.2g} ms, "
            f"scale {fit.scale:.4f} +- {1.96 * fit.sigma[2]:.1g}, "
            f"{1e3 * fit.bias:+.2f} mrad; residual {1e3 * fit.residual:.3g} mrad",
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
    """How far, how fast, and how much it turned."""
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


def _noise_text(found: Inspection, channel: str) -> str:
    noise = found.cleaned.noise[channel]
    if not math.isfinite(noise.sigma):
        return f"{channel} ?"
    return f"{channel} {size_text(channel, noise.sigma)}"


def _flagged_text(found: Inspection) -> str:
    """How many samples of which channels are not taken as data, and why."""
    recording = found.recording
    texts = []
    for channel in recording.channels:
        flags = recording.flags[channel]
        counts = [
            f"{int((flags & flag > 0).sum())} {str(flag.name).lower().replace('_', ' ')}"
            for flag in Flag
            if (flags & flag).any()
        ]
        if counts:
            texts.append(f"{channel}: {', '.join(counts)}")
    return "; ".join(texts) or "nothing"


def _table(found: Sequence[Inspection]) -> doc.Table:
    head = ["Recording", "Samples", "Length", "Noise of x", "Noise of phi", "Warnings"]
    rows = []
    for one in found:
        noise, t, count = one.cleaned.noise, one.recording.t, len(one.doubts)
        rows.append(
            [
                one.name,
                str(len(t)),
                f"{t[-1] - t[0]:.4g} s",
                size_text("x", noise["x"].sigma),
                size_text("phi", noise["phi"].sigma),
                doc.Badge(str(count), "warn") if count else doc.Badge("none", "good"),
            ]
        )
    return doc.table(head, rows)


class _Report(Report):
    def drawn(
        self, result: InspectedRecordings, progress: Progress = quiet
    ) -> tuple[doc.Figure, ...]:
        """Of several recordings each name begins with the file's."""
        several, figures = len(result.recordings) > 1, []
        for place, one in enumerate(result.recordings, 1):
            progress(f"figures {place} of {len(result.recordings)}" if several else "figures")
            for figure in doc.captioned(self.captions, self.draw(one)):
                own = {
                    "name": f"{stem_of(one)}-{figure.name}",
                    "title": f"{one.name}: {figure.title}",
                }
                figures.append(replace(figure, **own) if several else figure)
        return tuple(figures)

    def save(
        self,
        result: InspectedRecordings,
        path: str | Path,
        *,
        netcdf: str | Path | None = None,
        **options: Any,
    ) -> list[Path]:
        """Write inspection.json, the page and, for one recording, a netCDF file."""
        if netcdf is None:
            return super().save(result, path, **options)
        file_for_result(Path(netcdf))
        return [*super().save(result, path, **options), _netcdf(Path(netcdf), result.recordings[0])]


def _netcdf(path: Path, found: Inspection) -> Path:
    """Write the cleaned recording, whole. Raises InputError without the extra."""
    from rr_opt.recordings.readers.netcdf import write_netcdf

    with whole(path) as temporary:
        write_netcdf(temporary, replace(found.recording, doubts=found.doubts), found.gait)
    return path


# The figures are in the page alone: there may be dozens.
REPORT = _Report(
    inspection_record,
    inspection_document,
    "inspection.json",
    figures="rr_opt.report.figures.inspection",
    captions=captions("inspection"),
    svgs=False,
)
