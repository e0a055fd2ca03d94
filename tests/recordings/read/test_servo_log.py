"""A servo's log gives its counts, and the angles that the scale of the servo makes of them."""

from __future__ import annotations

import math

import numpy as np
import pytest

from rr_opt.files.issue import InvalidFileError
from rr_opt.model.experiment import CountScale
from rr_opt.recordings.readers import ReadOptions, read_file
from rr_opt.recordings.readers.plain_csv import ServoLog

TEXT = "t,goal,present\n7.000,512,500\n7.004,614.4,512\n7.008,,1023\n7.012,0,\n"


def test_counts_and_angles_of_the_cds5516(write):
    log = read_file(write(TEXT))
    assert isinstance(log, ServoLog)
    assert log.rate == pytest.approx(250.0)
    assert log.t.tolist() == [7.0, 7.004, 7.008, 7.012]
    np.testing.assert_array_equal(log.goal, [512, 614.4, np.nan, 0])
    np.testing.assert_array_equal(log.present, [500, 512, 1023, np.nan])
    np.testing.assert_allclose(np.degrees(log.goal_angle), [0, 30, np.nan, -150])
    assert log.resolution == pytest.approx(0.0051, rel=5e-3)
    assert log.doubts == ()


def test_another_scale_and_a_servo_that_turns_the_other_way(write):
    log = read_file(write(TEXT), ReadOptions(counts=CountScale(4096, -2 * math.pi, 500.0)))
    np.testing.assert_allclose(log.present_angle[:2], [0, -12 * 2 * math.pi / 4096])
    assert log.resolution > 0


@pytest.mark.parametrize("column", ["goal", "present"])
def test_one_column_will_do(write, column):
    log = read_file(write(f"{column};t\n512,5;0\n513;0,004\n"))
    assert getattr(log, column).tolist() == [512.5, 513.0]
    other = {"goal": "present", "present": "goal"}[column]
    assert getattr(log, other) is None
    assert getattr(log, f"{other}_angle") is None


def test_counts_beyond_the_scale_are_doubted(write):
    (doubt,) = read_file(write(TEXT.replace("614.4", "2000"))).doubts
    assert "1 positions lie outside 0 to 1023 counts" in doubt


def test_disorder_is_told_and_is_no_data(write):
    log = read_file(write("t,present\n0,1\n0.008,2\n0.012,3\n0.004,4\n0.016,5\n0.016,6\n"))
    np.testing.assert_array_equal(log.t, [0, 0.004, 0.008, 0.012, 0.016])
    np.testing.assert_array_equal(log.present, [1, np.nan, 2, 3, np.nan])
    assert len(log.doubts) == 3


@pytest.mark.parametrize(
    ("text", "line", "message"),
    [
        ("t,goal\n0,1\n1,up\n", 3, "Read 'up' in column 2 (goal)"),
        ("goal,present\n1,2\n3,4\n", 1, "Expected also `t`"),
        ("t,goal\n0,1\n", 1, "Read 1 row"),
    ],
)
def test_refused(write, text, line, message):
    with pytest.raises(InvalidFileError) as caught:
        read_file(write(text))
    (issue,) = caught.value.issues
    assert issue.line == line
    assert message in issue.message
