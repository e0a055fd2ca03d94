"""A file is read by what it holds, whatever it is called."""

from __future__ import annotations

import numpy as np
import pytest

from rr_opt.model.experiment import Recording
from rr_opt.recordings.readers import read_file
from rr_opt.recordings.readers.marker_rows import MarkerData
from rr_opt.recordings.readers.netcdf import write_netcdf
from rr_opt.recordings.readers.plain_csv import ServoLog

TEXTS = {
    "plain": ("t,x,y,psi,phi\n0,1,2,3,4\n1,1,2,3,4\n", Recording),
    "servo": ("t,goal,present\n0,1,2\n1,1,2\n", ServoLog),
    "vicon": (
        "Trajectories\n100\n,,A,,\nFrame,Sub Frame,X,Y,Z\n,,mm,mm,mm\n1,0,1,2,3\n",
        MarkerData,
    ),
    "trc": (
        "PathFileType\t4\t(X/Y/Z)\ta.trc\nDataRate\tNumMarkers\tUnits\n100\t1\tmm\n"
        "Frame#\tTime\tA\t\t\n\t\tX1\tY1\tZ1\n\n1\t0\t1\t2\t3\n",
        MarkerData,
    ),
}
NAMES = ("a.csv", "a.trc", "a.c3d", "a.nc", "a.txt", "a")


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("kind", TEXTS)
def test_texts(write, kind, name):
    text, made = TEXTS[kind]
    read = read_file(write(text, name))
    assert isinstance(read, made)
    assert read.name == name


@pytest.mark.parametrize("name", NAMES)
def test_netcdf(write, tmp_path, name):
    run = read_file(write(TEXTS["plain"][0]))
    assert isinstance(read_file(write_netcdf(tmp_path / name, run)), Recording)


@pytest.mark.parametrize("name", NAMES)
def test_c3d(tmp_path, name):
    ezc3d = pytest.importorskip("ezc3d")
    file = ezc3d.c3d()
    file["parameters"]["POINT"]["RATE"]["value"] = [100.0]
    file["parameters"]["POINT"]["LABELS"]["value"] = ["A"]
    file["data"]["points"] = np.ones((4, 1, 3))
    file.write(str(tmp_path / "written.c3d"))
    (tmp_path / "written.c3d").rename(tmp_path / name)
    assert isinstance(read_file(tmp_path / name), MarkerData)
