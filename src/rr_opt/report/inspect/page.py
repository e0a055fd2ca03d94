"""report.html of an inspection, its text for a terminal, and its folder."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from html import escape
from pathlib import Path

import numpy as np

from rr_opt.answers.quantities import number, with_unit
from rr_opt.model.experiment import Flag
from rr_opt.recordings.inspection import Inspection
from rr_opt.recordings.time_axis import time_step
from rr_opt.recordings.warnings import size_text
from rr_opt.report.archive import remove, whole, write_json, write_text
from rr_opt.report.html import CSS, Badge, Cell, card, figure, table
from rr_opt.report.inspect.record import path_record, record
from rr_opt.report.text import columns
from rr_opt.version import __version__


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


_CAPTIONS = {
    "path": ("The joint's path", "P seen from above. Arrows: platform 1's heading."),
    "channels": (
        "Channels",
        "What is taken as data. Bands: gaps; gaps of up to 0.1 s are bridged by a thin line, in "
        "this figure only. Crosses: flagged samples, those within the axes.",
    ),
    "command": (
        "phi against its command",
        "Above: samples at their phase of the period. Below: the difference over time.",
    ),
    "rigid": (
        "Markers on rigid platforms",
        "What is left of a fit of two rigid platforms joined at P: by frame, and by marker.",
    ),
    "noise": (
        "Noise",
        "From sixth differences, with a 95 % interval, against the stated noise. White noise is "
        "the same at half the frequency; behind a low-pass filter it is larger there.",
    ),
}
_COLUMNS = (("path", "noise", "rigid"), ("channels", "command"))


def page(
    name: str, sha256: str, found: Sequence[Inspection], drawn: Sequence[Mapping[str, str]]
) -> str:
    """The whole page; drawn: of each recording its figures, SVG texts by name."""
    several = len(found) > 1
    body = [_header(name, found), card("Recordings", _table(found)) if several else ""]
    for one, figures in zip(found, drawn, strict=True):
        title = one.name if several else "What was read"
        body += [card(title, _of_one(one)), _gallery(figures, one.name if several else "")]
    body.append(
        f"<footer>rr-opt {escape(__version__)} · input SHA-256 "
        f"<code>{escape(sha256)}</code></footer>"
    )
    return (
        '<!DOCTYPE html>\n<html lang="en"><head><meta charset="utf-8">'
        '<meta name="viewport" content="width=device-width, initial-scale=1">'
        f"<title>{escape(name)}: {escape(_verdict(found))}</title><style>{CSS}</style></head>\n"
        "<body><main>\n" + "\n".join(part for part in body if part) + "\n</main></body></html>\n"
    )


def _verdict(found: Sequence[Inspection]) -> str:
    count = sum(len(one.doubts) for one in found)
    what = f"{len(found)} recordings" if len(found) > 1 else "A recording"
    if not count:
        return f"{what} without a doubt"
    return f"{what} with {count} doubt{'s' if count > 1 else ''}"


def _header(name: str, found: Sequence[Inspection]) -> str:
    doubted = [one.name for one in found if one.doubts]
    lead = "Nothing looks wrong in what was read."
    if doubted:
        lead = (
            "Read each doubt below before the recording is used. Nothing was filled in or dropped."
        )
    return (
        f'<header class="{"bad" if doubted else ""}"><p class="kind">Roller Racer · '
        f"{escape(name)} · recordings</p><h1>{escape(_verdict(found))}</h1>"
        f'<p class="lead">{escape(lead)}</p></header>'
    )


def _table(found: Sequence[Inspection]) -> str:
    head = ["Recording", "Samples", "Length", "Noise of x", "Noise of phi", "Doubts"]
    lines: list[list[Cell]] = []
    for one in found:
        noise, t = one.cleaned.noise, one.recording.t
        count = len(one.doubts)
        lines.append(
            [
                one.name,
                str(len(t)),
                f"{t[-1] - t[0]:.4g} s",
                size_text("x", noise["x"].sigma),
                size_text("phi", noise["phi"].sigma),
                Badge(str(count), "assumed") if count else Badge("none", "yes"),
            ]
        )
    return table(head, lines)


def _of_one(found: Inspection) -> str:
    items = "".join(f'<li class="bad">{escape(text)}</li>' for text in found.doubts)
    doubts = f'<ul class="checks">{items or "<li>No doubts.</li>"}</ul>'
    facts = [[name.strip(), text] for name, text in rows(found)]
    sigma = {name: float(np.median(one)) for name, one in found.recording.sigma.items()}
    facts.append(["sigma taken", ", ".join(f"{n} {size_text(n, s)}" for n, s in sigma.items())])
    return doubts + table(["What", "Found"], facts)


def _gallery(figures: Mapping[str, str], prefix: str) -> str:
    columns = []
    for names in _COLUMNS:
        column = ""
        for name in names:
            if name in figures:
                title, caption = _CAPTIONS[name]
                column += figure(figures[name], f"{prefix}: {title}" if prefix else title, caption)
        columns.append(column)
    return f'<div class="grid">{"".join(f"<div>{one}</div>" for one in columns if one)}</div>'


RECORD, PAGE = "inspection.json", "report.html"


def write_inspection(
    name: str,
    sha256: str,
    found: Sequence[Inspection],
    folder: Path,
    *,
    figures: bool,
    progress: Callable[[str], object],
) -> list[Path]:
    """Write everything; returns the files in the order to name them."""
    remove(folder, (RECORD, PAGE))
    written = [write_json(folder / RECORD, record(name, sha256, found))]
    if not figures:
        return written
    # Here and not above: without figures matplotlib need not be loaded.
    from rr_opt.report.figures.inspection import draw

    drawn = []
    for place, one in enumerate(found, 1):
        progress(f"figures {place} of {len(found)}")
        drawn.append(draw(one))
    return [write_text(folder / PAGE, page(name, sha256, found, drawn)), *written]


def write_recording(path: Path, found: Inspection) -> Path:
    """Write the cleaned recording to a netCDF file, whole. Raises InputError without the extra."""
    from rr_opt.recordings.readers.netcdf import write_netcdf

    with whole(path) as temporary:
        write_netcdf(temporary, replace(found.recording, doubts=found.doubts), found.gait)
    return path
