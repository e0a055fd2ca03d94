"""Markers of OptiTrack Motive and Qualisys files are where the files have them."""

import numpy as np
import pytest

from rr_opt.files.issue import InvalidFileError
from rr_opt.model.experiment import Layout
from rr_opt.recordings.inspection import Circumstances, inspected
from rr_opt.recordings.readers import MarkerData, read_file
from tests.recordings.read.test_experiment import PLACES, motion

QUALISYS = (
    "NO_OF_FRAMES\t3\nNO_OF_CAMERAS\t10\nNO_OF_MARKERS\t2\nFREQUENCY\t100\nDESCRIPTION\t--\n"
    "TIME_STAMP\t2026-01-19, 10:19:43.755\t2063631.9\nDATA_INCLUDED\t3D\n"
    "MARKER_NAMES\tleft\tNew 0002\nTRAJECTORY_TYPES\tMeasured\tMeasured\n"
    "Frame\tTime\tleft X\tleft Y\tleft Z\tNew 0002 X\tNew 0002 Y\tNew 0002 Z\t\n"
    "1\t0.00000\t819.834\t277.770\t22.421\t694.169\t-183.362\t97.003\n"
    "2\t0.01000\t819.835\t277.770\t22.420\t\t\t\n"
    "3\t0.02000\t819.851\t277.778\t22.400\t0.000\t0.000\t0.000\n"
)
MOTIVE = (
    "Format Version,1.23,Take Name,Take 1,Capture Frame Rate,120.000000,Export Frame Rate,"
    "120.000000,Total Exported Frames,3,Rotation Type,Quaternion,Length Units,Meters,"
    "Coordinate Space,Global\n"
    "\n"
    ",,Rigid Body,Rigid Body,Rigid Body,Rigid Body Marker,Rigid Body Marker,Rigid Body Marker,"
    "Marker,Marker,Marker,Marker,Marker,Marker\n"
    ",,R,R,R,R:1,R:1,R:1,R:1,R:1,R:1,R:2,R:2,R:2\n"
    ",,9F,9F,9F,A1,A1,A1,A2,A2,A2,A3,A3,A3\n"
    ",,Position,Position,Position,Position,Position,Position,Position,Position,Position,"
    "Position,Position,Position\n"
    "Frame,Time (Seconds),X,Y,Z,X,Y,Z,X,Y,Z,X,Y,Z\n"
    "0,0.000000,9,9,9,8,8,8,1.0,0.1,2.0,1.5,0.1,2.5\n"
    "1,0.008333,9,9,9,8,8,8,1.1,0.1,2.0,,,\n"
    "2,0.016667,9,9,9,8,8,8,1.2,0.1,2.0,1.7,0.1,2.5\n"
)


def test_qualisys(write):
    data = read_file(write(QUALISYS, "a.tsv"))
    assert isinstance(data, MarkerData)
    assert data.labels == ("left", "New 0002")
    assert data.t.tolist() == [0, 0.01, 0.02]
    np.testing.assert_allclose(data.positions[2, 0], [0.819851, 0.277778, 0.0224])
    assert np.isnan(data.positions[1:, 1]).all()
    assert data.rate == pytest.approx(100)


def test_qualisys_without_frames_and_times(write):
    head, rows = QUALISYS.split("Frame\t", 1)
    bare = "".join(row.split("\t", 2)[2] + "\n" for row in rows.splitlines()[1:])
    data = read_file(write(head + bare, "a.tsv"))
    timed = read_file(write(QUALISYS, "b.tsv"))
    np.testing.assert_allclose(data.t, timed.t)
    np.testing.assert_array_equal(data.positions, timed.positions)


def test_motive(write):
    data = read_file(write(MOTIVE))
    assert isinstance(data, MarkerData)
    assert data.labels == ("1", "2")
    np.testing.assert_allclose(data.positions[0], [[1, 0.1, 2], [1.5, 0.1, 2.5]])
    assert np.isnan(data.positions[1, 1]).all()
    assert data.rate == pytest.approx(120, rel=1e-3)
    assert data.doubts[0] == "Columns not read: 'Rigid Body, Rigid Body Marker'."


def test_motive_with_a_time_code_and_titles(write):
    lines = MOTIVE.splitlines()
    for at, title in zip(range(2, 6), ("Type", "Name", "ID", ""), strict=True):
        lines[at] = f",{title},{lines[at][1:]}"
    lines[6] = lines[6].replace("(Seconds),", "(Seconds),TimeCode,")
    for at in range(7, 10):
        frame, time, rest = lines[at].split(",", 2)
        lines[at] = f"{frame},{time},15:26:46:12.02,{rest}"
    data = read_file(write("\n".join(lines) + "\n"))
    np.testing.assert_array_equal(data.positions, read_file(write(MOTIVE, "b.csv")).positions)


def test_a_robot_seen_by_motive_with_y_up(write):
    moved = motion(200)
    t, x, y, psi, phi = moved
    names = list(PLACES)
    head = [
        "Format Version,1.23,Capture Frame Rate,100.0,Length Units,Millimeters",
        "",
        ",," + ",".join(["Marker"] * 3 * len(names)),
        ",," + ",".join(f"RR:{name}" for name in names for _ in range(3)),
        ",," + ",".join(["Position"] * 3 * len(names)),
        "Frame,Time (Seconds)" + ",X,Y,Z" * len(names),
    ]
    for k in range(len(t)):
        cells = [str(k), f"{t[k]:.6f}"]
        for platform, forward, left in PLACES.values():
            turn = psi[k] + (phi[k] if platform == 2 else 0)
            seen = complex(x[k], y[k]) + complex(forward, left) * np.exp(1j * turn)
            # With y up the floor's first axis is the capture's z, and the second its x.
            cells += [f"{1000 * seen.imag:.4f}", "50", f"{1000 * seen.real:.4f}"]
        head.append(",".join(cells))
    places = [{n: p[1:] for n, p in PLACES.items() if p[0] == one} for one in (1, 2)]
    found = inspected(write("\n".join(head) + "\n"), Circumstances(layout=Layout(*places, up="y")))
    for name, true in zip(("x", "y", "psi", "phi"), moved[1:], strict=True):
        np.testing.assert_allclose(found.recording.values[name], true, atol=2e-4)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (QUALISYS.replace("MARKER_NAMES\tleft\tNew 0002\n", "").replace("3D", "6D"), "'6D'"),
        (QUALISYS.replace("FREQUENCY\t100", "FREQUENCY\tfast"), "Read 'fast' as FREQUENCY"),
        (QUALISYS.replace("277.770", "x", 1), "Read 'x' in column 4 (Y of left)"),
        (QUALISYS.split("1\t0.00", maxsplit=1)[0], "no rows"),
        (MOTIVE.replace(",Marker", ",Bone"), "Expected positions of the type `Marker`"),
        (MOTIVE.replace("Frame,Time", "Row,Time"), "Read no row `Frame,Time"),
        (MOTIVE.replace("120.000000", "?"), "as the frame rate"),
        (MOTIVE.replace("Meters", "Ells"), "Read the unit 'Ells'"),
        (MOTIVE.split("0,0.000000", maxsplit=1)[0], "no rows"),
        (MOTIVE.replace("1,0.008333,9", "1,0.008333,nine"), "Read 'nine'"),
    ],
)
def test_refused(write, text, message):
    with pytest.raises(InvalidFileError) as caught:
        read_file(write(text))
    assert message in str(caught.value)
