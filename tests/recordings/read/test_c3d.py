"""A C3D file gives what the program that wrote it, ezc3d, was told to write.

The size of a residual is not compared: ezc3d writes it to the byte that the format has for the
cameras (its issue 386). `test_c3d_by_hand.py` does that.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from rr_opt.recordings.readers import read_file
from rr_opt.recordings.readers.marker_rows import MarkerData

ezc3d = pytest.importorskip("ezc3d")

LABELS = ("RR:A", "RR:B", "RR:C", "*4")


def written(path: Path, points, residuals=None, labels=LABELS, unit="mm", rate=100.0, more=()):
    """points (n, k, 3) and residuals (n, k) by ezc3d; more: (group, name, value)."""
    file = ezc3d.c3d()
    n, k = points.shape[:2]
    file["parameters"]["POINT"]["RATE"]["value"] = [rate]
    file["parameters"]["POINT"]["LABELS"]["value"] = list(labels)
    file["parameters"]["POINT"]["UNITS"]["value"] = [unit] if unit else []
    for group, name, value in more:
        file.add_parameter(group, name, value)
    whole = np.ones((4, k, n))
    whole[:3] = points.transpose(2, 1, 0)
    file["data"]["points"] = whole
    if residuals is not None:
        file["data"]["meta_points"]["residuals"] = residuals.T[None].astype(float)
    file.write(str(path))
    return path


@pytest.fixture
def points():
    return np.random.default_rng(7).normal(0, 900, (40, 4, 3))


def test_places_names_rate_and_what_was_not_seen(tmp_path, points):
    residuals = np.full((40, 4), 3.0)
    residuals[5:9, 1] = -1.0
    data = read_file(written(tmp_path / "a.c3d", points, residuals))
    assert isinstance(data, MarkerData)
    assert data.labels == ("A", "B", "C", "*4")
    assert (data.rate, data.source["unit"], data.source["subject"]) == (100.0, "mm", "RR")
    assert data.frame.tolist() == list(range(1, 41))
    np.testing.assert_allclose(data.t, np.arange(40) / 100, atol=1e-15)
    missing = np.zeros((40, 4), bool)
    missing[5:9, 1] = True
    assert (np.isnan(data.positions).all(axis=2) == missing).all()
    np.testing.assert_allclose(data.positions[~missing], points[~missing] / 1000, atol=1e-7)
    assert (data.residual[~missing] >= 0).all()
    assert np.isnan(data.residual[missing]).all()
    assert data.doubts == ()


@pytest.mark.parametrize(("unit", "metre"), [("mm", 1e-3), ("m", 1.0), ("cm", 1e-2)])
def test_units_of_the_file(tmp_path, points, unit, metre):
    data = read_file(written(tmp_path / "a.c3d", points, unit=unit))
    np.testing.assert_allclose(data.positions, points * metre, rtol=1e-6)


def test_zeros_and_nan_are_missing(tmp_path, points):
    points[3, 0], points[4, 1] = 0.0, np.nan
    data = read_file(written(tmp_path / "a.c3d", points))
    assert np.argwhere(np.isnan(data.positions).all(axis=2)).tolist() == [[3, 0], [4, 1]]
    assert data.doubts == ("1 positions are exactly 0, 0, 0 and were taken as missing.",)


def test_points_that_are_angles_are_no_markers(tmp_path, points):
    more = [("POINT", "ANGLES", ["RR:B"])]
    data = read_file(written(tmp_path / "a.c3d", points, more=more))
    assert data.labels == ("A", "C", "*4")
    np.testing.assert_allclose(data.positions, points[:, [0, 2, 3]] / 1000, atol=1e-7)
    assert data.doubts == ("1 points are not positions and were not read.",)


def test_analog_samples_between_the_points(tmp_path, points):
    file = ezc3d.c3d(str(written(tmp_path / "a.c3d", points)))
    analog = np.random.default_rng(1).normal(size=(1, 3, 40 * 5))
    file["parameters"]["ANALOG"]["RATE"]["value"] = [500.0]
    file["parameters"]["ANALOG"]["LABELS"]["value"] = ["a", "b", "c"]
    file["data"]["analogs"] = analog
    file.write(str(tmp_path / "b.c3d"))
    data = read_file(tmp_path / "b.c3d")
    np.testing.assert_allclose(data.positions, points / 1000, atol=1e-7)


def test_more_markers_than_one_list_of_names_holds(tmp_path):
    points = np.random.default_rng(7).normal(0, 900, (3, 300, 3))
    labels = [f"M{n}" for n in range(300)]
    data = read_file(written(tmp_path / "a.c3d", points, labels=labels))
    assert data.labels == tuple(labels)
    np.testing.assert_allclose(data.positions, points / 1000, atol=1e-6)


def test_more_frames_than_the_header_can_count(tmp_path):
    """As many frames are read as were written; ezc3d itself reads 65535 of them."""
    points = np.random.default_rng(7).normal(0, 900, (65_800, 1, 3))
    data = read_file(written(tmp_path / "a.c3d", points, labels=["A"]))
    assert len(data) == 65_800
    np.testing.assert_allclose(data.positions, points / 1000, atol=1e-6)
    assert data.doubts[0].startswith("The header cannot count beyond frame 65535")
