"""C3D is read as the format's description has it, for every processor and kind of number.

The bytes are laid out by hand from the description (c3d.org, user guide).
"""

from __future__ import annotations

import struct

import numpy as np
import pytest

from rr_opt.files.issue import InvalidFileError
from rr_opt.recordings.readers import read_file

INTEL, DEC, MIPS = 84, 85, 86
PLACES = [(100.0, -250.0, 3.5), (101.0, -251.0, 4.5)]


def number(value: float, processor: int) -> bytes:
    if processor == DEC:
        low, high = struct.unpack("<2H", struct.pack("<f", value * 4))
        return struct.pack("<2H", high, low)
    return struct.pack(">f" if processor == MIPS else "<f", value)


def file(
    processor=INTEL, scale=-1.0, places=PLACES, first=1, last=None, fourth=5, **changed
) -> bytes:
    """Two frames of one marker, with two analog samples a frame."""
    order = ">" if processor == MIPS else "<"

    def words(*values: int) -> bytes:
        return struct.pack(f"{order}{len(values)}H", *values)

    last = first + len(places) - 1 if last is None else last
    header = bytes([2, 0x50]) + words(1, 2, first, last, 0) + number(scale, processor)
    header += words(3, 2) + number(200.0, processor)
    entries = bytes([5, 256 - 1]) + b"POINT" + words(3) + b"\0"
    for name, kind, dimensions, content in (
        (b"LABELS", -1, (4, 1), changed.get("label", b"front"[:4])),
        (b"UNITS", -1, (2,), changed.get("unit", b"mm")),
        (b"RATE", 4, (), number(200.0, processor)),
    ):
        body = struct.pack("2b", kind, len(dimensions)) + bytes(dimensions) + content + b"\0"
        entries += bytes([len(name), 1]) + name + words(2 + len(body)) + body
    parameters = bytes([0, 0x50, 1, processor]) + entries + b"\0\0"
    frames = b""
    for place in places:
        whole = [round(value / scale) for value in place] if scale > 0 else place
        for value in (*whole, fourth if isinstance(fourth, int) else fourth.pop(0), 9, 9):
            frames += (
                number(value, processor) if scale < 0 else struct.pack(f"{order}h", int(value))
            )
    content = header.ljust(512, b"\0") + parameters.ljust(512, b"\0") + frames
    return content.ljust(1536, b"\0")


@pytest.mark.parametrize("scale", [-0.5, 0.5])
@pytest.mark.parametrize("processor", [INTEL, DEC, MIPS])
def test_every_processor_and_kind_of_number(write, processor, scale):
    data = read_file(write(file(processor, scale), "a.c3d"))
    assert data.labels == ("fron",)
    assert data.rate == 200.0
    np.testing.assert_allclose(data.positions[:, 0], np.array(PLACES) / 1000, rtol=1e-7)
    np.testing.assert_allclose(data.residual, 5 * 0.5 / 1000)


def test_cameras_above_the_residual(write):
    data = read_file(write(file(fourth=0x7F05), "a.c3d"))
    np.testing.assert_allclose(data.residual, 0.005)


def test_a_fourth_number_below_0_is_a_missing_marker(write):
    data = read_file(write(file(fourth=-1), "a.c3d"))
    assert np.isnan(data.positions).all()
    assert "Never seen: fron." in data.doubts


def test_places_that_software_made_up_are_told(write):
    data = read_file(write(file(fourth=[5, 0]), "a.c3d"))
    assert any("1 positions have residual 0" in doubt for doubt in data.doubts)


def test_frames_that_do_not_begin_at_1(write):
    data = read_file(write(file(first=101), "a.c3d"))
    assert data.frame.tolist() == [101, 102]
    assert data.t.tolist() == [0.5, 0.505]


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (file()[:1040], "has 0 frames"),
        (file()[:520], "damaged or incomplete"),
        (file()[:512], "names no processor type"),
        (file(last=40_000), "states 1 markers in 40000 frames"),
        (file(first=5, last=3), "in -1 frames"),
        (file(scale=-np.inf), "its scale is"),
        (file(unit=b"K "), "Read the unit 'K'"),
        (file(unit=b"mm")[:515] + b"\0" + file()[516:], "names no processor type"),
    ],
)
def test_what_is_damaged_is_refused(write, content, message):
    with pytest.raises(InvalidFileError, match=message):
        read_file(write(content, "a.c3d"))
