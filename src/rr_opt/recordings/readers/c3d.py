"""C3D, the binary format of motion capture (c3d.org, user guide).

A header of 512 bytes, the parameters, then frame after frame the points and the analog samples. The
parameters are groups of named numbers and texts, a chain of entries, each with the distance to the
next; nothing in a damaged chain is followed out of the file or backwards. It is read here, and not
by a library: the usual one ends the program on damaged files, and reads no more than 65535 frames,
11 minutes at 100 Hz.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from math import prod

import numpy as np
from numpy.typing import NDArray

from rr_opt.files.issue import refuse
from rr_opt.recordings.readers.marker_rows import MarkerData, MarkerRows, marker_data
from rr_opt.recordings.readers.text import Reader, ReadOptions
from rr_opt.recordings.warnings import Notice, notice

INTEL, DEC, MIPS = 84, 85, 86
"""The processors whose numbers a file may hold, as byte 4 of the parameters names them."""

_TYPES = {-1: "S1", 1: "i1", 2: "i2", 4: "f4"}
_MOST_ENTRIES = 5000

Values = tuple[float, ...] | tuple[str, ...]


def numbers(content: bytes, kind: str, count: int, start: int, processor: int) -> NDArray:
    """`count` numbers of a numpy kind (`i2`, `u2`, `f4`, ...) in a processor's form, from a byte.

    Raises ValueError if the content ends before.
    """
    if start < 0 or count < 0 or start + count * np.dtype(kind).itemsize > len(content):
        raise ValueError("it ends before its parameters do")
    if kind == "f4" and processor == DEC:
        # A VAX float is an IEEE float times four, its 16-bit halves the other way round.
        halves = np.frombuffer(content, "<u2", 2 * count, start).reshape(-1, 2)
        return np.ascontiguousarray(halves[:, ::-1]).view("<f4")[:, 0] / np.float32(4)
    order = ">" if processor == MIPS else "<"
    return np.frombuffer(content, f"{order}{kind}", count, start)


def read_parameters(content: bytes, start: int, processor: int) -> Mapping[str, Values]:
    """All parameters, by `GROUP:NAME`, of the section that starts at a byte.

    Raises ValueError for a chain that leaves the file.
    """
    groups: dict[int, str] = {}
    found: list[tuple[int, str, Values]] = []
    at = start + 4
    for _ in range(_MOST_ENTRIES):
        length, group = (int(one) for one in numbers(content, "i1", 2, at, processor))
        name_end = at + 2 + abs(length)
        if length == 0 or group == 0:
            break
        name = content[at + 2 : name_end].decode("latin-1").strip().upper()
        step = int(numbers(content, "i2", 1, name_end, processor)[0])
        if group < 0:
            groups[-group] = name
        else:
            found.append((group, name, _values(content, name_end + 2, processor)))
        if step <= 0:
            break
        at = name_end + step
    return {f"{groups.get(group, '')}:{name}": values for group, name, values in found}


def _values(content: bytes, at: int, processor: int) -> Values:
    """What a parameter holds: numbers, or texts along its first dimension."""
    kind, dimensions = (int(one) for one in numbers(content, "i1", 2, at, processor))
    sizes = [int(one) for one in numbers(content, "u1", max(dimensions, 0), at + 2, processor)]
    first = at + 2 + len(sizes)
    if kind not in _TYPES:
        raise ValueError(f"a parameter of the type {kind}")
    if kind != -1:
        return tuple(
            float(one) for one in numbers(content, _TYPES[kind], prod(sizes), first, processor)
        )
    width = sizes[0] if sizes else 1
    count = prod(sizes[1:])
    if first + width * count > len(content):
        raise ValueError("a text beyond its end")
    return tuple(
        content[first + width * n : first + width * (n + 1)].decode("latin-1").strip(" \0")
        for n in range(count)
    )


BLOCK = 512
_LAST_COUNT = 65535
"""The largest frame number that the header can hold."""


@dataclass(frozen=True)
class Header:
    """What the header says.

    points, analogs  numbers of them in a frame; first, last: the frames' own numbers
    scale            the unit of whole numbers, in which positions are stored; negative: as floats
    start            the byte at which the frames begin; rate: of the frames, Hz
    """

    processor: int
    points: int
    analogs: int
    first: int
    last: int
    scale: float
    start: int
    rate: float

    @property
    def kind(self) -> str:
        """How the numbers of a frame are stored."""
        return "f4" if self.scale < 0 else "i2"

    @property
    def frame_bytes(self) -> int:
        """How many bytes a frame takes."""
        return (4 * self.points + self.analogs) * (4 if self.scale < 0 else 2)


def read_header(content: bytes) -> Header:
    """Raises ValueError."""
    at = BLOCK * (content[0] - 1) + 3
    if at >= len(content) or content[at] not in (INTEL, DEC, MIPS):
        raise ValueError("it names no kind of processor")
    processor = content[at]
    points, analogs, first, last = (int(one) for one in numbers(content, "u2", 4, 2, processor))
    scale = float(numbers(content, "f4", 1, 12, processor)[0])
    start = int(numbers(content, "u2", 1, 16, processor)[0])
    rate = float(numbers(content, "f4", 1, 20, processor)[0])
    if not np.isfinite(scale) or scale == 0:
        raise ValueError(f"its scale is {scale:g}")
    if start < 2:
        raise ValueError("it does not say where its frames begin")
    return Header(processor, points, analogs, first, last, scale, BLOCK * (start - 1), rate)


def frame_count(
    content: bytes, header: Header, parameters: Mapping[str, Values], file: str
) -> tuple[int, list[Notice]]:
    """How many frames there are, and what is odd about their number. Raises InvalidFileError."""
    end = parameters.get("TRIAL:ACTUAL_END_FIELD", ())
    last = header.last
    if last == _LAST_COUNT and len(end) == 2:
        # Two 16-bit words, the low one first; both are stored with a sign.
        last = sum((int(word) % 65536) << shift for word, shift in zip(end, (0, 16), strict=True))
    stated = last - header.first + 1
    room = len(content) - header.start
    there = room // header.frame_bytes if header.points else 0
    if not header.points or stated < 1 or there < stated:
        refuse(
            file,
            f"The file states {header.points} markers in {stated} frames, and has {max(there, 0)} "
            "frames. It is damaged or not whole: export it once more.",
        )
    if last == _LAST_COUNT and room >= stated * header.frame_bytes + BLOCK:
        # The last block is filled up with zeros, which are no frames.
        count = max(len(content.rstrip(b"\0")) - header.start, 0)
        count = -(-count // header.frame_bytes)
        return count, [notice("file.counter", last=_LAST_COUNT, count=count)]
    return stated, []


def points_of(
    content: bytes, header: Header, count: int, kept: list[int]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Positions (n, k, 3) and residuals (n, k), below 0 where a marker was not seen."""
    width = 4 * header.points + header.analogs
    available = min(count * width, (len(content) - header.start) // (header.frame_bytes // width))
    flat = numbers(content, header.kind, available, header.start, header.processor)
    if available < count * width:
        flat = np.concatenate([flat, np.zeros(count * width - available, flat.dtype)])
    read = flat.reshape(count, width)[:, : 4 * header.points].reshape(count, header.points, 4)
    with np.errstate(invalid="ignore"):  # damaged bytes may be signalling NaNs
        chosen = read[:, kept].astype(float)
    last = np.nan_to_num(chosen[:, :, 3], nan=-1.0, posinf=-1.0, neginf=-1.0)
    # The fourth number is a whole one: its low byte the residual, above it which cameras saw it.
    low = np.clip(last, -1, 65535).astype(np.int64) & 0xFF
    residual = np.where(last < 0, -1.0, low * abs(header.scale))
    positions = chosen[:, :, :3] * (header.scale if header.scale > 0 else 1.0)
    return positions, residual


_KEY = 0x50
"""The second byte of every C3D file."""
_NOT_MARKERS = ("ANGLES", "FORCES", "MOMENTS", "POWERS", "SCALARS")
"""Parameters of the group POINT that list points which are no places."""


def sniff(content: bytes) -> bool:
    """Whether the first bytes are those of a C3D file."""
    return len(content) > 1 and content[1] == _KEY and 0 < content[0] < 128


def read(file: str, content: bytes, _: ReadOptions) -> MarkerData:
    """The markers of a C3D file. A residual below 0 is a marker that was not seen."""
    try:
        header = read_header(content)
        parameters = read_parameters(content, BLOCK * (content[0] - 1), header.processor)
    except ValueError as error:
        refuse(file, f"The C3D file is damaged or not whole: {error}. Export it once more.")
    count, doubts = frame_count(content, header, parameters, file)
    labels = _labels(parameters, header.points)
    others = {one for key in _NOT_MARKERS for one in parameters.get(f"POINT:{key}", ())}
    kept = [at for at, label in enumerate(labels) if label not in others]
    if len(kept) < len(labels):
        doubts.append(notice("file.points", count=len(labels) - len(kept)))
    if not kept:
        refuse(file, "The C3D file has no markers. Expected at least one. Export the trajectories.")
    positions, residual = points_of(content, header, count, kept)
    endless = np.isinf(positions).any(axis=2)
    if endless.any():
        doubts.append(notice("marker.infinite", count=endless.sum()))
    positions[endless | ~(residual >= 0)] = np.nan
    residual[~(residual >= 0)] = np.nan
    made_up = residual == 0
    if made_up.any() and (residual > 0).any():
        doubts.append(notice("marker.filled", count=made_up.sum()))
    rate = _number(parameters, "POINT:RATE", header.rate)
    frame = header.first + np.arange(count, dtype=np.int64)
    unit = parameters.get("POINT:UNITS", ())
    rows = MarkerRows(
        frame=frame,
        t=None,
        rate=rate,
        labels=tuple(labels[at] for at in kept),
        positions=positions,
        unit=str(unit[0]) if unit else "",
        unit_place=("the parameter POINT:UNITS", None),
        lines=frame,
        residual=residual,
    )
    return marker_data(rows, {"file": file, "format": "C3D"}, doubts)


def _labels(parameters: Mapping[str, Values], count: int) -> list[str]:
    """The names of all points: LABELS holds 255 at most, LABELS2 the next ones."""
    keys = ["POINT:LABELS", *(f"POINT:LABELS{n}" for n in range(2, 300))]
    labels = [str(one) for key in keys for one in parameters.get(key, ())]
    return (labels + [""] * count)[:count]


def _number(parameters: Mapping[str, Values], name: str, default: float) -> float:
    values = parameters.get(name, ())
    return float(values[0]) if values and isinstance(values[0], float) else default


READER = Reader("C3D", sniff, read, binary=True)
