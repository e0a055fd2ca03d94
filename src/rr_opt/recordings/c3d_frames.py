"""The frames of a C3D file: how they are stored, how many there are, and the points in them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rr_opt.recordings.c3d_parameters import DEC, INTEL, MIPS, Values, numbers
from rr_opt.recordings.refusal import refuse

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
) -> tuple[int, list[str]]:
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
        return count, [
            f"The header can count to frame {_LAST_COUNT} only; the file has {count} frames, and "
            "all were read."
        ]
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
