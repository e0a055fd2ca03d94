"""A Vicon Nexus CSV gives the markers of its section `Trajectories`, in metres, and no more.

The files are laid out by hand from the format's description.
"""

from __future__ import annotations

import numpy as np
import pytest

from rr_opt.files.issue import InvalidFileError
from rr_opt.recordings.readers import read_file
from rr_opt.recordings.readers.marker_rows import MarkerData

SECTION = """\
Trajectories
200
,,RR:left,,,RR:right,,
Frame,Sub Frame,X,Y,Z,X,Y,Z
,,mm,mm,mm,mm,mm,mm
11,0,1000,-2000.5,30,1.25e3,,
12,0,1001,-2001.5,31,1251,2001,71
13,0,,,,1252,2002,72
"""
DEVICES = """\
Devices
1000
,,Imaginary Plate - Force,,
Frame,Sub Frame,Fx,Fy,Fz
,,N,N,N
11,0,1,2,3
11,1,1,2,3

"""
MODEL = """
Model Outputs
200
,,RR:Knee,,
Frame,Sub Frame,X,Y,Z
,,deg,deg,deg
11,0,1,2,3
"""
LEFT = np.array([[1.0, -2.0005, 0.03], [1.001, -2.0015, 0.031], [np.nan] * 3])
RIGHT = np.array([[np.nan] * 3, [1.251, 2.001, 0.071], [1.252, 2.002, 0.072]])


def check(data):
    assert isinstance(data, MarkerData)
    assert data.labels == ("left", "right")
    assert data.frame.tolist() == [11, 12, 13]
    assert data.t.tolist() == [10 / 200, 11 / 200, 12 / 200]
    assert data.rate == 200.0
    np.testing.assert_allclose(data.positions[:, 0], LEFT, rtol=1e-14)
    np.testing.assert_allclose(data.positions[:, 1], RIGHT, rtol=1e-14)


def test_as_described(write):
    data = read_file(write(SECTION))
    check(data)
    assert data.source["subject"] == "RR"
    assert data.doubts == ("The first frame is 11, so t begins at 0.05 s.",)


@pytest.mark.parametrize(
    "text",
    [
        "\n\n" + SECTION,
        DEVICES + SECTION,
        SECTION + MODEL,
        SECTION + MODEL.lstrip(),
        DEVICES + SECTION + MODEL,
        DEVICES.replace("\n\n", "\n,,,,\n") + SECTION.replace("\n1", ",,,\n1") + MODEL,
        SECTION.replace("\n", "\r\n"),
        SECTION.replace("\n", ",,,,,,,,,,\n"),
        SECTION.replace(",,\n12", "\n12"),
        SECTION.replace("Trajectories", "TRAJECTORIES").replace("200\n", "200,Hz\n", 1),
        SECTION.replace("Trajectories", '"Trajectories"').replace("Frame,", '"Frame",', 1),
        SECTION.replace(",", ";"),
        SECTION.replace(",", ";").replace(".", ","),
        SECTION.replace(",", "\t"),
        SECTION.replace("RR:", ""),
        SECTION.rstrip("\n"),
        SECTION.replace("RR:right,,\n", "RR:right\n"),
    ],
)
def test_the_same_in_other_dress(write, text):
    check(read_file(write(text)))


def test_other_sections_are_told(write):
    doubts = read_file(write(DEVICES + SECTION + MODEL)).doubts
    assert "Sections not read: devices, model outputs." in doubts


def test_velocities_beside_the_places_are_not_taken_for_them(write):
    text = """\
Trajectories
100
,,A,,,,,,B,,,,,
Frame,Sub Frame,X,Y,Z,X',Y',Z',X,Y,Z,X',Y',Z'
,,mm,mm,mm,mm/s,mm/s,mm/s,mm,mm,mm,mm/s,mm/s,mm/s
1,0,1,2,3,9,9,9,4,5,6,9,9,9
2,0,1,2,3,9,9,9,4,5,6,9,9,9
"""
    data = read_file(write(text))
    assert data.labels == ("A", "B")
    np.testing.assert_allclose(data.positions[0] * 1000, [[1, 2, 3], [4, 5, 6]])
    assert data.doubts == ("Columns not read: \"x', y', z'\".",)


@pytest.mark.parametrize(
    ("names", "labels"),
    [
        (",,*1,,,*2,,", ("*1", "*2")),
        (",,RR 1:A,,,RR 1:B,,", ("A", "B")),
        (",,one:A,,,two:A,,", ("one:A", "two:A")),
        (",,A,,,A,,", ("A", "A (2)")),
        (",,,,,B,,", ("unnamed 1", "B")),
        ("", ("unnamed 1", "unnamed 2")),
    ],
)
def test_names(write, names, labels):
    data = read_file(write(SECTION.replace(",,RR:left,,,RR:right,,", names)))
    assert data.labels == labels


@pytest.mark.parametrize(("unit", "metre"), [("mm", 1e-3), ("m", 1.0), ("cm", 1e-2)])
def test_units(write, unit, metre):
    data = read_file(write(SECTION.replace("mm", unit)))
    assert data.positions[0, 0, 0] == pytest.approx(1000 * metre)
    assert data.source["unit"] == unit


def test_a_unit_that_is_not_stated_is_assumed_and_told(write):
    data = read_file(write(SECTION.replace("mm", "")))
    assert data.positions[0, 0, 0] == pytest.approx(1.0)
    assert "millimetres were assumed" in data.doubts[0]


def test_frames_that_are_missing_there_twice_or_out_of_place(write):
    rows = "".join(f"{n},0,{n},0,5,{n},1,5\n" for n in (1, 2, 5, 4, 6, 6, 20))
    rows += "7,0,7,0,5,8,1,5\n7,0,9,0,5,8,1,5\n"
    data = read_file(write(SECTION.split("11,0", maxsplit=1)[0] + rows))
    assert data.frame.tolist() == [1, 2, 4, 5, 6, 7, 20]
    seen = [2, 4, 5, 6]
    np.testing.assert_allclose(data.positions[1:5, 0, 0] * 1000, seen)
    assert np.isnan(data.positions[5]).all()
    told = " ".join(data.doubts)
    for words in ("Out of order", "time as another row", "different values", "jumps twice"):
        assert words.replace("twice", "2 times") in told


def test_zeros_are_missing_markers(write):
    data = read_file(write(SECTION.replace("1251,2001,71", "0,0,0")))
    assert np.isnan(data.positions[1, 1]).all()
    assert any("exactly 0, 0, 0" in doubt for doubt in data.doubts)


REFUSED = {
    "the rate": (SECTION.replace("200\n", "fast\n", 1), 2, "Read 'fast' in column 1"),
    "a rate of 0": (SECTION.replace("200\n", "0\n", 1), 2, "Read '0' in column 1"),
    "no columns": (SECTION.replace("X,Y,Z", "RX,RY,RZ"), 4, "no columns `X,Y,Z`"),
    "no heights": (SECTION.replace("X,Y,Z", "X,Y,W"), 4, "no columns `X,Y,Z`"),
    "no frames": (SECTION.replace("Frame,Sub Frame", "No,"), 4, "Expected the row `Frame,Sub"),
    "a word": (SECTION.replace("2001,71", "lost,71"), 7, "Read 'lost' in column 7 (y of RR:right)"),
    "half a frame": (SECTION.replace("12,0", "12.5,0"), 7, "Read 12.5 as a frame number"),
    "no frame": (SECTION.replace("12,0", ",0"), 7, "as a frame number"),
    "another unit": (SECTION.replace("mm", "deg"), 5, "Read the unit 'deg'"),
    "two units": (SECTION.replace("mm", "m", 1), 5, "Read the units 'm, mm'"),
    "no rows": (SECTION.split("11,0", maxsplit=1)[0] + "\n", 5, "has no rows"),
    "half a header": ("\n".join(SECTION.splitlines()[:3]), 3, "ends within the header"),
    "no markers": (DEVICES, None, "Read the section 'devices' and no `Trajectories`"),
}


@pytest.mark.parametrize("case", REFUSED)
def test_refused_with_its_line(write, case):
    text, line, message = REFUSED[case]
    with pytest.raises(InvalidFileError) as caught:
        read_file(write(text))
    (issue,) = caught.value.issues
    assert issue.line == line
    assert message in issue.message
