"""A car whose tyres give way, driven through bends: made by SciPy. Its speed, of a motor that
drives both axles, is sampled, held and late. And the rear tyres of the public recordings where
RR_OPT_REAL names their folder."""

import os
from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.signal import savgol_filter

import rr_opt as rr
from rr_opt.machines.car import RIGID
from rr_opt.recordings.machine_run import between_updates

REAL = os.environ.get("RR_OPT_REAL", "")
L, MF, MR, GAIN, AHEAD, LEFT = 0.1735, 0.847, 0.733, 0.35, 0.115, -0.01
FRONT, REAR = 0.015, 0.025
LATE, UPDATE = 0.08, 0.1
HEAD = """\
machine: car
parameters: {L: 0.1735, mf: 0.847, mr: 0.733, gain: 0.33, zero: 0, ahead: 0.115, left: -0.01}
"""


def speed(t, kind):
    return 1.6 + 0.5 * np.sin(0.9 * t + kind)


def steps(t, kind):
    """A steering command that changes four times in three seconds."""
    return turns(kind)[(np.asarray(t) / 0.75).astype(int)]


def ramps(t, kind):
    """One that turns round four times in three seconds."""
    return np.interp(t, 0.75 * np.arange(200), turns(kind))


def turns(kind):
    return np.random.default_rng(kind).choice([-0.6, -0.3, 0.0, 0.3, 0.6], 200)


def driven(seconds, kind, bends, share):
    """t, x, y, psi of the recorded point, and the speed that is measured, which is that of the
    front wheels by a share, as if none slipped: two axles, forces in proportion to slip angles."""
    lf, lr, mass = L * MR / (MF + MR), L * MF / (MF + MR), MF + MR
    inertia = mass * (L**2 + 0.08**2) / 12

    def rates(t, s):
        _, _, psi, side, turn = s
        v, delta = speed(t, kind), GAIN * bends(t, kind)
        front = -np.arctan2(side + lf * turn, v) + delta
        rear = -np.arctan2(side - lr * turn, v)
        force1, force2 = front / FRONT, rear / REAR
        return [v * np.cos(psi) - side * np.sin(psi), v * np.sin(psi) + side * np.cos(psi), turn,
                (force1 * np.cos(delta) + force2) / mass - v * turn,
                (lf * force1 * np.cos(delta) - lr * force2) / inertia]  # fmt: skip

    t = np.arange(0, seconds, 0.01)
    x, y, psi, _, _ = solve_ivp(rates, (0, seconds), [0.0] * 5, "LSODA", t, max_step=0.01,
                                rtol=1e-8, atol=1e-10).y  # fmt: skip
    ahead = AHEAD - lr
    x, y = (
        x + ahead * np.cos(psi) - LEFT * np.sin(psi),
        y + ahead * np.sin(psi) + LEFT * np.cos(psi),
    )
    v = speed(t, kind)
    return t, x, y, psi, v + share * (v / np.cos(GAIN * bends(t, kind)) - v)


def write(folder, bends, share, seconds=12.0):
    rng, entries = np.random.default_rng(3), []
    for kind in (0, 1, 2):
        t, x, y, psi, wheels = driven(seconds, kind, bends, share)
        seen = np.interp(np.floor(t / UPDATE + 1e-9) * UPDATE - LATE, t, wheels)
        x, y, psi = (
            one + sigma * rng.standard_normal(t.size)
            for one, sigma in ((x, 1e-3), (y, 1e-3), (psi, 3e-3))
        )
        columns = [t, x, y, psi, seen, bends(t, kind)]
        np.savetxt(folder / f"{kind}.csv", np.column_stack(columns), "%.7g", ",",
                   header="t,x,y,psi,vx,steering", comments="")  # fmt: skip
        entries.append(f"  - {{file: {kind}.csv{', use: holdout' if kind == 2 else ''}}}")
    (folder / "experiment.yaml").write_text(f"{HEAD}recordings:\n" + "\n".join(entries) + "\n")
    return folder


@pytest.mark.parametrize(("bends", "share"), [(steps, 0.0), (ramps, 0.5)])
def test_tyres_that_give_way_are_named(bends, share, tmp_path):
    found = rr.diagnose(write(tmp_path, bends, share))
    (slip,) = found.effects
    assert slip.name == "lateral_slip"
    for axle, true in (("front", FRONT), ("rear", REAR)):
        one = slip.parameters[axle]
        assert one.low < true - RIGID < one.high
        assert one.value == pytest.approx(true - RIGID, rel=0.1)
    assert found.found.parameters["speed_late"].value == pytest.approx(-LATE, abs=0.01)
    assert found.found.parameters["front_share"].value == pytest.approx(share, abs=0.05)
    errors = found.errors(held_out=True)
    assert all(e["after"] < 0.5 * e["parameters"] for e in errors.values())


def test_what_is_held_moves_on_between_updates():
    y = np.repeat([0.0, 0.0, 0.0, 1.0, 3.0, 3.0], 4)
    moved = between_updates(y, 4)
    assert moved[::4] == pytest.approx([0, 0, 0, 1, 3, 3])
    assert moved[10] == pytest.approx(0.5)
    assert moved[:9] == pytest.approx(np.zeros(9))


def test_what_is_held_begins_where_it_is():
    y = np.repeat([2.0, 1.0, 1.0], (2, 4, 4))
    assert between_updates(y, 4)[:3] == pytest.approx([2, 1.5, 1])
    assert between_updates(np.full(9, 0.7), 4) == pytest.approx(np.full(9, 0.7))


@pytest.mark.skipif(not REAL, reason="RR_OPT_REAL names no folder of public recordings")
def test_the_rear_tyres(tmp_path):
    """Against the mean slip angle of the rear axle per side acceleration: no model of the car."""
    folder = Path(REAL) / "car"
    one, *_, other = sorted(folder.glob("*.csv"))
    table = np.genfromtxt(one, delimiter=",", names=True)
    t, first = np.unique(table["vicon_time"], return_index=True)
    even = np.arange(t[0], t[-1], 0.01)
    pose = [table["vicon_x"], table["vicon_y"], np.unwrap(table["vicon_yaw"])]
    pose = [np.interp(even, t, z[first]) for z in pose]
    vx, vy, turn = (savgol_filter(z, 15, 3, deriv=1, delta=0.01) for z in pose)
    psi = pose[2]
    ahead, side = vx * np.cos(psi) + vy * np.sin(psi), vy * np.cos(psi) - vx * np.sin(psi)
    moving = ahead > 0.4
    slip = np.arctan((side - AHEAD * turn) / ahead)[moving]
    force = MR * (ahead * turn)[moving]
    slope = -np.polyfit(force, slip, 1)[0]
    (tmp_path / "experiment.yaml").write_text(
        HEAD + "columns: {t: vicon time, x: vicon x, y: vicon y, psi: vicon yaw, vx: vel encoder}\n"
        f"recordings:\n  - {{file: {one}}}\n  - {{file: {other}, use: holdout}}\n"
    )
    named = {e.name: e for e in rr.diagnose(tmp_path).effects}
    assert named["lateral_slip"].parameters["rear"].value == pytest.approx(slope, rel=0.2)
