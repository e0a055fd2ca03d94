"""A file of set points holds the angles of the gait, each at its time, in the form asked for."""

import math
import shutil
import subprocess

import numpy as np
import pytest

from rr_opt.model.gait import SineGait
from rr_opt.motion.setpoints import set_points
from rr_opt.results.setpoints import text_of
from tests.motion.gaits import EVERY

SHAPES = pytest.mark.parametrize("gait", EVERY.values(), ids=EVERY)

PROGRAM = """
#include <stdio.h>
#include "gait.h"
int main(void) {
    for (int i = 0; i < RR_GAIT_POINTS; i++)
        printf("%.9g %.9g\\n", (double)i / (double)RR_GAIT_RATE, (double)rr_gait_angle[i]);
    printf("%.9g 0\\n", (double)RR_GAIT_PERIOD);
    return 0;
}
"""


def table(text):
    head, *rows = text.splitlines()
    return head.split(","), np.array([[float(cell) for cell in row.split(",")] for row in rows]).T


@SHAPES
def test_csv(gait):
    points = set_points(gait, 125.0)
    head, (t, phi, degrees) = table(text_of(points, "csv"))
    assert head == ["t [s]", "phi [rad]", "phi [deg]"]
    assert np.diff(t) == pytest.approx(0.008, rel=1e-6)
    assert phi == pytest.approx(points.played.angle(t), abs=1e-8)
    assert degrees == pytest.approx(phi * 180 / math.pi, abs=1e-6)


@SHAPES
def test_servo(gait):
    points = set_points(gait, 125.0)
    head, (t, count) = table(text_of(points, "servo"))
    assert head == ["t [s]", "count"]
    angle = np.radians((count - 512) * 300 / 1024)
    assert np.abs(angle - points.played.angle(t)).max() <= np.radians(150 / 1024) + 1e-9


@pytest.mark.skipif(shutil.which("gcc") is None, reason="needs gcc")
@pytest.mark.parametrize(
    "gait", [*EVERY.values(), SineGait(1.0, 1.0), SineGait(1e-13, 0.064)], ids=str
)
def test_c_header(gait, tmp_path):
    points = set_points(gait, 125.0)
    (tmp_path / "gait.h").write_text(text_of(points, "c-header"))
    (tmp_path / "main.c").write_text(PROGRAM)
    strict = ["-Wall", "-Wextra", "-Werror", "-std=c99", "-pedantic"]
    subprocess.run(["gcc", *strict, "main.c", "-o", "main"], cwd=tmp_path, check=True)
    run = subprocess.run([tmp_path / "main"], capture_output=True, text=True, check=True)
    *rows, last = ([float(cell) for cell in row.split()] for row in run.stdout.splitlines())
    t, phi = np.array(rows).T
    assert phi == pytest.approx(points.played.angle(t), abs=1e-6)
    assert last[0] == pytest.approx(points.played.period, rel=1e-6)
