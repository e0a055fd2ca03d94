"""A TRC file gives the markers that stand in it, in metres, on its own clock.

The files are laid out by hand from the format's description.
"""

from __future__ import annotations

import numpy as np
import pytest

from rr_opt.files.issue import InvalidFileError
from rr_opt.recordings.readers import read_file
from rr_opt.recordings.readers.marker_rows import MarkerData

TEXT = """\
PathFileType\t4\t(X/Y/Z)\ttrial.trc
DataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\tOrigDataRate\tOrigDataStartFrame\tOrigNumFrames
50.00\t50.00\t3\t2\tmm\t50.00\t1\t3
Frame#\tTime\tfront\t\t\tback\t\t
\t\tX1\tY1\tZ1\tX2\tY2\tZ2

1\t0.00\t1000\t2\t3\t-4\t5\t6
2\t0.02\t1001\t2\t3\t\t\t
3\t0.04\t1002\t2\t3\t-6\t5\t6
"""


@pytest.mark.parametrize(
    "text",
    [
        TEXT,
        TEXT.replace("\n\n", "\n"),
        TEXT.replace("\n", "\t\r\n"),
        TEXT.replace("front\t\t\tback\t\t", "front\tback"),
        TEXT.replace("-4\t5\t6\n2\t0.02\t1001\t2\t3\t\t\t", "-4\t5\t6\n2\t0.02\t1001\t2\t3"),
        TEXT.replace("Units", "units").rstrip("\n"),
        TEXT.replace("0.0", "0,0").replace(".00", ",00"),
    ],
)
def test_as_described(write, text):
    data = read_file(write(text, "no-ending"))
    assert isinstance(data, MarkerData)
    assert data.labels == ("front", "back")
    assert data.frame.tolist() == [1, 2, 3]
    assert data.t.tolist() == [0.0, 0.02, 0.04]
    assert data.rate == pytest.approx(50.0)
    np.testing.assert_allclose(data.positions[:, 0, 0], [1.0, 1.001, 1.002])
    np.testing.assert_allclose(
        data.positions[[0, 2], 1], [[-0.004, 0.005, 0.006], [-0.006, 0.005, 0.006]]
    )
    assert np.isnan(data.positions[1, 1]).all()


def test_what_the_header_says_wrongly_is_told(write):
    text = TEXT.replace("50.00", "60.00", 1).replace("\t3\t2\tmm", "\t4\t3\tmm")
    data = read_file(write(text))
    assert data.rate == pytest.approx(50.0)
    assert data.doubts == (
        "The header states 3 markers but names 2.",
        "The header states 4 frames; the file has 3.",
        "The header states 60 Hz, but the times come at 50 Hz. The times were used.",
    )


def test_a_clock_that_does_not_begin_at_0_is_kept(write):
    data = read_file(write(TEXT.replace("\t0.0", "\t7.0")))
    assert data.t.tolist() == [7.0, 7.02, 7.04]


REFUSED = {
    "half a header": ("\n".join(TEXT.splitlines()[:4]), 4, "ends within its header"),
    "the rate": (TEXT.replace("50.00", "often", 1), 3, "Read 'often' as DataRate"),
    "the names": (TEXT.replace("Frame#", "Bild"), 4, "Expected `Frame#`"),
    "a word": (TEXT.replace("1001", "here"), 8, "Read 'here' in column 3 (X of front)"),
    "a unit": (TEXT.replace("mm", "volts"), 3, "Read the unit 'volts'"),
    "no rows": (TEXT.split("1\t0.00", maxsplit=1)[0], 5, "no rows"),
    "no frame": (TEXT.replace("\n2\t", "\n\t"), 8, "as a frame number"),
    "no time": (
        TEXT.replace("0.00\t1000", "\t1000").replace("0.02\t", "\t").replace("0.04\t", "\t"),
        7,
        "no row with a time",
    ),
}


@pytest.mark.parametrize("case", REFUSED)
def test_refused_with_its_line(write, case):
    text, line, message = REFUSED[case]
    with pytest.raises(InvalidFileError) as caught:
        read_file(write(text))
    (issue,) = caught.value.issues
    assert issue.line == line
    assert message in issue.message
