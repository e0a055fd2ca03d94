"""Whatever a file holds, reading it gives data that keep their promises, or a clear error."""

from __future__ import annotations

import struct
import time
from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from rr_opt.model.experiment import Recording
from rr_opt.outcome import InputError
from rr_opt.recordings.readers import read_file
from rr_opt.recordings.readers.marker_rows import MarkerData

FUZZ = settings(
    deadline=None, max_examples=120, suppress_health_check=[HealthCheck.function_scoped_fixture]
)
PLAIN = b"t,x,y,psi,phi\n0.00,1,2,3,4\n0.01,1,2,,4\n0.02,1,2,3,4\n"
SERVO = b"t;goal;present\r\n0,000;512;511\r\n0,004;513;512\r\n"
VICON = (
    b"Trajectories\n100\n,,A,,,B,,\nFrame,Sub Frame,X,Y,Z,X,Y,Z\n,,mm,mm,mm,mm,mm,mm\n"
    b"1,0,1,2,3,4,5,6\n2,0,1,2,3,,,\n"
)
TRC = (
    b"PathFileType\t4\t(X/Y/Z)\ta.trc\nDataRate\tNumMarkers\tUnits\n100\t1\tmm\n"
    b"Frame#\tTime\tA\t\t\n\t\tX1\tY1\tZ1\n\n1\t0\t1\t2\t3\n2\t0.01\t1\t2\t3\n"
)


def c3d() -> bytes:
    """One marker in three frames."""
    header = struct.pack("<2B5Hf2Hf", 2, 0x50, 1, 0, 1, 3, 0, -1.0, 3, 0, 100.0)
    unit = struct.pack("<2b", -1, 1) + b"\x02mm\0"
    entries = b"\x05\xffPOINT\x03\0\0" + b"\x05\x01UNITS" + struct.pack("<h", 2 + len(unit)) + unit
    parameters = bytes([0, 0x50, 1, 84]) + entries + b"\0\0"
    frames = struct.pack("<12f", *(100.0, 200.0, 3.0, 1.0) * 3)
    return header.ljust(512, b"\0") + parameters.ljust(512, b"\0") + frames.ljust(512, b"\0")


SIGNAL = bytes.fromhex("010080ff010080ff")
"""Two signalling NaNs."""

MOTIVE = (
    b"Format Version,1.23,Capture Frame Rate,100,Length Units,Meters\n\n,,Marker,Marker,Marker\n"
    b",,A,A,A\n,,1,1,1\n,,Position,Position,Position\nFrame,Time (Seconds),X,Y,Z\n"
    b"0,0.00,1,2,3\n1,0.01,1,2,3\n"
)
QUALISYS = (
    b"NO_OF_FRAMES\t2\nFREQUENCY\t100\nDATA_INCLUDED\t3D\nMARKER_NAMES\tA\n"
    b"Frame\tTime\tA X\tA Y\tA Z\n1\t0.00\t1\t2\t3\n2\t0.01\t1\t2\t3\n"
)
TRACKER = (
    b"Objects\n100\n,,A:A,,,,,,B:B,,,,,\nFrame,Sub Frame,RX,RY,RZ,TX,TY,TZ,RX,RY,RZ,TX,TY,TZ\n"
    b",,rad,rad,rad,mm,mm,mm,rad,rad,rad,mm,mm,mm\n"
    b"1,0,0,0,0.1,1,2,3,0,0,0.2,4,5,6\n2,0,0,0,0.1,1,2,3,0,0,0.3,4,5,6\n"
)
FILES = {
    "tracker": TRACKER,
    "motive": MOTIVE,
    "qualisys": QUALISYS,
    "plain": PLAIN,
    "servo": SERVO,
    "vicon": VICON,
    "trc": TRC,
    "c3d": c3d(),
}
PIECES = st.sampled_from(
    [
        piece.encode()
        for piece in (*',;\t\n\r-.0"#tX ', "nan", "inf", "1e999", "1e9", "-1e300", "mm")
    ]
    + [b"\xff", b"\0", b"\xef\xbb\xbf", b"\xff\xfe", b"Devices\n"]
)


def read(path: Path, content: bytes) -> None:
    """Reads, and checks what every reader promises."""
    path.write_bytes(content)
    told = data = None
    try:
        data = read_file(path)
    except InputError as error:
        told = str(error)
    if data is None:
        assert told is not None
        assert str(path) in told
        assert len(told) < 10_000
        return
    assert len(data) > 0
    assert np.isfinite(data.t).all()
    assert (np.diff(data.t) > 0).all()
    assert all(doubt.endswith((".", "?")) for doubt in data.doubts)
    if isinstance(data, MarkerData):
        assert data.positions.shape == (len(data.t), len(data.labels), 3)
        assert len(set(data.labels)) == len(data.labels)
        assert not np.isinf(data.positions).any()
        assert 0 < data.rate < np.inf
    if isinstance(data, Recording):
        for name in data.channels:
            missing = ~np.isfinite(data.values[name])
            assert (data.flags[name][missing] > 0).all()


def test_the_files_are_good_before_they_are_spoiled(tmp_path):
    for content in FILES.values():
        (tmp_path / "f").write_bytes(content)
        assert len(read_file(tmp_path / "f")) >= 2


@FUZZ
@given(
    kind=st.sampled_from(sorted(FILES)),
    cuts=st.lists(st.tuples(st.floats(0, 1), st.integers(0, 9), PIECES), max_size=4),
    end=st.floats(0.3, 1),
)
def test_pieces_put_in_taken_out_and_cut_off(tmp_path, kind, cuts, end):
    content = bytearray(FILES[kind])
    for place, length, piece in cuts:
        at = int(place * len(content))
        content[at : at + length] = piece
    read(tmp_path / "f", bytes(content[: int(end * len(content)) + 1]))


@FUZZ
@given(changes=st.lists(st.tuples(st.integers(0, 620), st.integers(0, 255)), max_size=6))
def test_bytes_of_a_binary_file(tmp_path, changes):
    content = bytearray(FILES["c3d"])
    for at, byte in changes:
        content[at] = byte
    read(tmp_path / "f", bytes(content))


@FUZZ
@given(lines=st.lists(st.sampled_from([*b"\n".join(FILES.values()).split(b"\n")]), max_size=12))
def test_lines_of_all_formats_in_any_order(tmp_path, lines):
    read(tmp_path / "f", b"\n".join(lines))


@FUZZ
@given(content=st.binary(max_size=200))
def test_any_bytes(tmp_path, content):
    read(tmp_path / "f", content)


CELLS = st.sampled_from(["", "nan", "0", "1", "-1", "1e9", "1e300", "-1e300", "1e-300", "inf"])


@FUZZ
@given(rows=st.lists(st.lists(CELLS, min_size=5, max_size=6), max_size=6))
def test_any_numbers_in_a_plain_file(tmp_path, rows):
    text = "\n".join(["t,x,y,psi,phi,torque", *(",".join(row) for row in rows)])
    read(tmp_path / "f", text.encode())


@FUZZ
@given(
    rows=st.lists(st.lists(CELLS, min_size=8, max_size=8), min_size=1, max_size=6),
    rate=st.sampled_from(["100", "1e-300", "1e300", "0.001"]),
)
def test_any_numbers_in_a_marker_file(tmp_path, rows, rate):
    head = VICON.decode().split("1,0,1")[0].replace("100", rate)
    read(tmp_path / "f", (head + "\n".join(",".join(row) for row in rows)).encode())


@FUZZ
@given(rows=st.lists(st.lists(CELLS, min_size=5, max_size=5), min_size=1, max_size=6))
def test_any_numbers_in_a_trc_file(tmp_path, rows):
    head = TRC.decode().split("1\t0\t1")[0]
    read(tmp_path / "f", (head + "\n".join("\t".join(row) for row in rows)).encode())


ONCE_FAILED = {
    "constant": PLAIN.replace(b"1,2", b"5,5"),
    "one time": b"t,x,y,psi,phi\n" + b"0,1,2,3,4\n" * 50_000,
    "empty rows": b"t,x,y,psi,phi\n" + b",,,,\n" * 1000,
    "no rows": b"t,x,y,psi,phi\n",
    "one word": b"t" * 1_000_000,
    "wide": b"t,x,y,psi,phi" + b"," * 100_000 + b"\n0,1,2,3,4\n1,1,2,3,4\n",
    "huge times": PLAIN.replace(b"0.01", b"1e300").replace(b"0.02", b"2e300"),
    "tiny times": PLAIN.replace(b"0.01", b"5e-324").replace(b"0.02", b"1e-323"),
    "times of all sizes": PLAIN.replace(b"0.01", b"1e9").replace(b"0.02", b"1e-300"),
    "a huge time": PLAIN + b"1e308,1,2,3,4\n",
    "signalling NaN": c3d().replace(struct.pack("<f", 100.0) + struct.pack("<f", 200.0), SIGNAL),
    "endless label": c3d().replace(b"\xff\x01\x02mm", b"\xff\x04\xff\xff\xff\xff"),
}


@pytest.mark.parametrize("case", ONCE_FAILED)
def test_what_once_failed(tmp_path, case):
    """With errors, endless loops or a time that grows with the square of the size."""
    start = time.process_time()
    read(tmp_path / "f", ONCE_FAILED[case])
    assert time.process_time() - start < 5
