"""C3D, the binary format of motion capture (c3d.org, user guide).

A header of 512 bytes, the parameters, then frame after frame the points and the analog samples. The
parameters are groups of named numbers and texts, a chain of entries, each with the distance to the
next; a damaged chain is never followed out of the file or backwards. It is read here, not by a
library: the usual one ends the program on damaged files, and reads no more than 65535 frames, 11
minutes at 100 Hz.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from math import prod
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rr_opt.files.issue import refuse
from rr_opt.recordings.readers.marker_rows import MarkerData, marker_data
from rr_opt.recordings.readers.text import Reader, ReadOptions
from rr_opt.recordings.warnings import Notice, notice

INTEL, DEC, MIPS = 84, 85, 86
"""Number formats by processor, as given by byte 4 of the parameters."""
_BLOCK = 512
_LAST_COUNT = 65535
"""The largest frame number that the header can hold."""
_TYPES = {-1: "S1", 1: "i1", 2: "i2", 4: "f4"}
_MOST_ENTRIES = 5000

Parameters = Mapping[str, tuple[Any, ...]]
"""Numbers or texts by `GROUP:NAME`."""


@dataclass(frozen=True)
class Bytes:
    """The content of a file, and the processor whose number format it uses."""

    content: bytes
    processor: int

    def numbers(self, kind: str, count: int, start: int) -> NDArray:
        """`count` numbers of a numpy kind (`i2`, `u2`, `f4`, ...), from a byte.

        Raises ValueError if the content ends before.
        """
        if min(start, count) < 0 or start + count * np.dtype(kind).itemsize > len(self.content):
            raise ValueError("it ends before its parameters do")
        if kind == "f4" and self.processor == DEC:
            # A VAX float is an IEEE float times four, its 16-bit halves the other way round.
            halves = np.frombuffer(self.content, "<u2", 2 * count, start).reshape(-1, 2)
            return np.ascontiguousarray(halves[:, ::-1]).view("<f4")[:, 0] / np.float32(4)
        order = ">" if self.processor == MIPS else "<"
        return np.frombuffer(self.content, f"{order}{kind}", count, start)

    def integers(self, kind: str, count: int, start: int) -> list[int]:
        """The same as a list of integers."""
        return self.numbers(kind, count, start).tolist()

    def text(self, start: int, length: int) -> str:
        """A text without the blanks about it. Raises ValueError if the content ends before."""
        if start + length > len(self.content):
            raise ValueError("a text that runs past its end")
        return self.content[start : start + length].decode("latin-1").strip(" \0")


def read_parameters(file: Bytes, start: int) -> Parameters:
    """All parameters of the section that starts at a byte.

    Raises ValueError for a chain that leaves the file.
    """
    groups: dict[int, str] = {}
    found: list[tuple[int, str, tuple[Any, ...]]] = []
    at = start + 4
    for _ in range(_MOST_ENTRIES):
        length, group = file.integers("i1", 2, at)
        if length == 0 or group == 0:
            break
        end = at + 2 + abs(length)
        name = file.text(at + 2, abs(length)).strip().upper()
        (step,) = file.integers("i2", 1, end)
        if group < 0:
            groups[-group] = name
        else:
            found.append((group, name, _values(file, end + 2)))
        if step <= 0:
            break
        at = end + step
    return {f"{groups.get(group, '')}:{name}": values for group, name, values in found}


def _values(file: Bytes, at: int) -> tuple[Any, ...]:
    """What a parameter holds: numbers, or texts along its first dimension."""
    kind, dimensions = file.integers("i1", 2, at)
    sizes = file.integers("u1", max(dimensions, 0), at + 2)
    first = at + 2 + len(sizes)
    if kind not in _TYPES:
        raise ValueError(f"a parameter of the type {kind}")
    if kind != -1:
        return tuple(file.numbers(_TYPES[kind], prod(sizes), first).astype(float).tolist())
    width, count = sizes[0] if sizes else 1, prod(sizes[1:])
    file.text(first, width * count)
    return tuple(file.text(first + width * n, width) for n in range(count))


@dataclass(frozen=True)
class C3dHeader:
    """What the header says.

    points, analogs  numbers of them in a frame; first, last: the frames' own numbers
    scale            the unit of whole numbers, in which positions are stored; negative: as floats
    start            the byte at which the frames begin; rate: of the frames, Hz
    """

    points: int
    analogs: int
    first: int
    last: int
    scale: float
    start: int
    rate: float

    @property
    def frame_bytes(self) -> int:
        """How many bytes a frame takes."""
        return (4 * self.points + self.analogs) * (4 if self.scale < 0 else 2)


def read_header(content: bytes) -> tuple[Bytes, C3dHeader]:
    """Raises ValueError."""
    at = _BLOCK * (content[0] - 1) + 3
    if at >= len(content) or content[at] not in (INTEL, DEC, MIPS):
        raise ValueError("it names no processor type")
    file = Bytes(content, content[at])
    scale, rate = (float(file.numbers("f4", 1, place)[0]) for place in (12, 20))
    (start,) = file.integers("u2", 1, 16)
    if not np.isfinite(scale) or scale == 0:
        raise ValueError(f"its scale is {scale:g}")
    if start < 2:
        raise ValueError("it does not say where its frames begin")
    points, analogs, first, last = file.integers("u2", 4, 2)
    return file, C3dHeader(points, analogs, first, last, scale, _BLOCK * (start - 1), rate)


def frame_count(
    content: bytes, header: C3dHeader, parameters: Parameters, file: str
) -> tuple[int, list[Notice]]:
    """How many frames there are, and what is odd about their number. Raises InvalidFileError."""
    end = parameters.get("TRIAL:ACTUAL_END_FIELD", ())
    last = header.last
    if last == _LAST_COUNT and len(end) == 2:
        # Two 16-bit words, the low one first; both are stored with a sign.
        last = int(end[0]) % 65536 + (int(end[1]) % 65536 << 16)
    stated = last - header.first + 1
    room = len(content) - header.start
    there = room // header.frame_bytes if header.points else 0
    if not header.points or stated < 1 or there < stated:
        refuse(
            file,
            f"The file states {header.points} markers in {stated} frames, and has {max(there, 0)} "
            "frames. It is damaged or incomplete: export it again.",
        )
    if last == _LAST_COUNT and room >= stated * header.frame_bytes + _BLOCK:
        # The last block is filled up with zeros, which are no frames.
        count = max(len(content.rstrip(b"\0")) - header.start, 0)
        count = -(-count // header.frame_bytes)
        return count, [notice("file.counter", last=_LAST_COUNT, count=count)]
    return stated, []


def points_of(
    file: Bytes, header: C3dHeader, count: int, kept: list[int]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Positions (n, k, 3) and residuals (n, k), below 0 where a marker was not seen."""
    width = 4 * header.points + header.analogs
    room = (len(file.content) - header.start) // (header.frame_bytes // width)
    kind = "f4" if header.scale < 0 else "i2"
    flat = file.numbers(kind, min(count * width, room), header.start)
    # The zeros that fill the last block may be cut off.
    flat = np.pad(flat, (0, count * width - len(flat)))
    read = flat.reshape(count, width)[:, : 4 * header.points].reshape(count, header.points, 4)
    with np.errstate(invalid="ignore"):  # damaged bytes may be signalling NaNs
        chosen = read[:, kept].astype(float)
    last = np.nan_to_num(chosen[:, :, 3], nan=-1.0, posinf=-1.0, neginf=-1.0)
    # The fourth number is a whole one: its low byte the residual, above it which cameras saw it.
    low = np.clip(last, -1, 65535).astype(np.int64) & 0xFF
    residual = np.where(last < 0, -1.0, low * abs(header.scale))
    return chosen[:, :, :3] * (header.scale if header.scale > 0 else 1.0), residual


_KEY = 0x50
"""The second byte of every C3D file."""
_NOT_MARKERS = ("ANGLES", "FORCES", "MOMENTS", "POWERS", "SCALARS")
"""Parameters of the group POINT that list points which are not positions."""


def sniff(content: bytes) -> bool:
    """Whether the first bytes are those of a C3D file."""
    return len(content) > 1 and content[1] == _KEY and 0 < content[0] < 128


def read(file: str, content: bytes, _: ReadOptions) -> MarkerData:
    """The markers of a C3D file. A residual below 0 is a marker that was not seen."""
    try:
        whole, header = read_header(content)
        parameters = read_parameters(whole, _BLOCK * (content[0] - 1))
    except ValueError as error:
        refuse(file, f"The C3D file is damaged or incomplete: {error}. Export it again.")
    count, doubts = frame_count(content, header, parameters, file)
    labels = _labels(parameters, header.points)
    others = {one for key in _NOT_MARKERS for one in parameters.get(f"POINT:{key}", ())}
    kept = [at for at, label in enumerate(labels) if label not in others]
    if len(kept) < len(labels):
        doubts.append(notice("file.points", count=len(labels) - len(kept)))
    if not kept:
        refuse(file, "The C3D file has no markers. Expected at least one. Export the trajectories.")
    positions, residual = points_of(whole, header, count, kept)
    endless = np.isinf(positions).any(axis=2)
    if endless.any():
        doubts.append(notice("marker.infinite", count=endless.sum()))
    positions[endless | ~(residual >= 0)] = np.nan
    residual[~(residual >= 0)] = np.nan
    made_up = residual == 0
    if made_up.any() and (residual > 0).any():
        doubts.append(notice("marker.filled", count=made_up.sum()))
    rate = next(iter(parameters.get("POINT:RATE", ())), header.rate)
    frame = header.first + np.arange(count, dtype=np.int64)
    unit = parameters.get("POINT:UNITS", ())
    return marker_data(
        {"file": file, "format": "C3D"},
        frame=frame,
        lines=frame,
        t=None,
        rate=rate if isinstance(rate, float) else header.rate,
        labels=[labels[at] for at in kept],
        positions=positions,
        unit=str(unit[0]) if unit else "",
        unit_place=("the parameter POINT:UNITS", None),
        residual=residual,
        doubts=doubts,
    )


def _labels(parameters: Parameters, count: int) -> list[str]:
    """The names of all points: LABELS holds 255 at most, LABELS2 the next ones."""
    keys = ["POINT:LABELS", *(f"POINT:LABELS{n}" for n in range(2, 300))]
    labels = [str(one) for key in keys for one in parameters.get(key, ())]
    return (labels + [""] * count)[:count]


READER = Reader("C3D", sniff, read, binary=True)
