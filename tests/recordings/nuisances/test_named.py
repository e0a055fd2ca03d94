"""Each nuisance is told by its name, with its time, place and size; a right recording has none."""

import re
from dataclasses import replace

import numpy as np
import pytest

from rr_opt.model.gait import SineGait
from rr_opt.recordings.nuisances import frame
from rr_opt.recordings.nuisances.evidence import FAR, ROLLING, ExaminedRecording
from tests.recordings.nuisances.spoilt import GAIT, NOISE, ROBOT, recording, told


def exchanged(v):
    v["x"], v["y"] = v["y"], v["x"]


def platforms(v):
    v["psi"], v["phi"] = v["psi"] + v["phi"] + np.pi, -v["phi"]


def scaled(**factors):
    def change(v):
        for name, factor in factors.items():
            v[name] = factor * v[name]

    return change


def moved(**steps):
    def change(v):
        for name, step in steps.items():
            v[name] = v[name] + step

    return change


def noisier(spoil):
    """The change, and six times the usual noise."""

    def change(v):
        rng = np.random.default_rng(1)
        spoil(v)
        for name in ("x", "y", "psi", "phi"):
            v[name] = v[name] + 6 * NOISE.of(name) * rng.normal(size=len(v["t"]))

    return change


FRAMES = {
    "x and y are swapped": exchanged,
    "x is mirrored": scaled(x=-1),
    "y is mirrored": scaled(y=-1),
    "psi has the other sign": scaled(psi=-1),
    "phi has the other sign": scaled(phi=-1),
    "psi is off by 180 deg": moved(psi=np.pi),
    "psi is off by 90 deg": moved(psi=np.pi / 2),
    "psi is off by -90 deg": moved(psi=-np.pi / 2),
    "phi is off by 180 deg": moved(phi=np.pi),
    "platforms 1 and 2 are swapped": platforms,
    "x and y are 0.02 times too large": scaled(x=0.02, y=0.02),
}


@pytest.mark.parametrize("turned", [0.0, 1.3, 2.6, -2.0])
@pytest.mark.parametrize("start", ["running", "rest"])
def test_a_right_recording_has_none(turned, start):
    assert told(recording(turned=turned, start=start), start=start)[0] == set()


@pytest.mark.parametrize("turned", [0.0, 1.3])
@pytest.mark.parametrize("name", FRAMES)
def test_a_wrong_frame(name, turned):
    codes, text = told(recording(turned=turned, change=FRAMES[name]))
    assert codes - {"motion.robot"} == {"frame.wrong"}
    assert f"if {name}. Expected" in re.sub(r"0\.0(2\d+|19\d+)", "0.02", text)


@pytest.mark.parametrize(("gait", "named"), [(GAIT, True), (SineGait(0.35, 1.5), False)])
def test_a_mirrored_floor_that_small_faults_explain_too(gait, named):
    """Of a robot that drives nearly along x, in more noise: a tracked point beside the joint makes
    as little slip."""

    spoilt = recording(gait=gait, turned=0.2, change=noisier(scaled(y=-1)))
    assert ROLLING < ExaminedRecording(spoilt, ROBOT, gait).slip.size < FAR
    assert ("frame.wrong" in told(spoilt, gait=gait)[0]) == named


def test_exchanged_platforms_that_small_faults_explain_too():
    """phi against its command shows them all the same."""
    gait = SineGait(0.5, 1.6)
    spoilt = recording(gait=gait, change=noisier(platforms))
    given = ExaminedRecording(spoilt, ROBOT, gait)
    assert given.forgiven.size < ROLLING < given.slip.size < FAR
    assert "platforms 1 and 2 are swapped" in told(spoilt, gait=gait)[1]


def test_two_wrongs():
    def change(v):
        FRAMES["y is mirrored"](v)
        FRAMES["phi is off by 180 deg"](v)

    assert "y is mirrored and phi is off by 180 deg" in told(recording(change=change))[1]


def test_the_search_for_delays_costs_no_more_at_a_higher_rate(monkeypatch):
    quick = recording()
    quick = replace(quick, t=quick.t / 10_000)
    tries, size = [], ExaminedRecording.slip_of
    monkeypatch.setattr(
        ExaminedRecording, "slip_of", lambda *given: tries.append(1) or size(*given)
    )
    frame._best(ExaminedRecording(quick, ROBOT, GAIT, "running"), (3,))
    assert len(tries) < 300


def test_without_a_robot_its_lengths_are_fitted():
    for name in ("y is mirrored", "psi is off by 180 deg", "phi is off by 180 deg"):
        assert f"if {name}" in told(recording(change=FRAMES[name]), robot=None, gait=None)[1]


@pytest.mark.parametrize("late", [0.05, 0.03, -0.05])
@pytest.mark.parametrize("name", ["phi", "psi", "x and y"])
def test_a_channel_that_is_late(name, late):
    def change(v):
        for one in name.split(" and "):
            v[one] = np.interp(v["t"] - late, v["t"], v[one])

    codes, text = told(recording(change=change))
    assert codes & {"late.phi", "late.place"} == {"late.phi" if name == "phi" else "late.place"}
    size = float(re.search(rf"others: {name} by ([-+.\d]+) ms\.", text)[1])
    assert abs(size - 1e3 * late) < 4


@pytest.mark.parametrize("times", [0.5, 2.0, 1.15])
def test_a_clock_that_changes_its_rate(times):
    def change(v):
        v["t"] = np.where(v["t"] < 10, v["t"], 10 + times * (v["t"] - 10))

    codes, text = told(recording(change=change))
    assert codes == {"clock.change"}
    at, before, after = (float(one) for one in re.findall(r"[\d.]+(?= s\b)", text))
    assert abs(at - 10) < GAIT.period / 2
    assert abs(before / GAIT.period - 1) < 0.03
    assert abs(after / (times * GAIT.period) - 1) < 0.05


@pytest.mark.parametrize("seed", [4, 12, 34, 37])
def test_gaps_are_no_change_of_the_clock(seed):
    def change(v):
        rng = np.random.default_rng(seed)
        for start in rng.uniform(0, 20, 8):
            lost = (v["t"] > start) & (v["t"] < start + rng.uniform(0.3, 0.6) * GAIT.period)
            for name in ("x", "y", "psi", "phi"):
                v[name] = np.where(lost, np.nan, v[name])

    assert "clock.change" not in told(recording(change=change))[0]


@pytest.mark.parametrize("seconds", [0.0, 0.2, 0.5])
@pytest.mark.parametrize("direction", np.arange(4) * np.pi / 2)
def test_a_push(seconds, direction):
    far, start = 0.1, 8.0

    def change(v):
        part = np.clip((v["t"] - start) / (seconds or 1e-9), 0, 1)
        v["x"] = v["x"] + far * np.cos(direction) * part
        v["y"] = v["y"] + far * np.sin(direction) * part

    spoilt = recording(change=change)
    codes, text = told(spoilt)
    assert codes in ({"push.robot"}, {"push.surge"})
    t, x, y = map(
        float, re.search(r"t = ([\d.]+) s, where x = ([-\d.]+) m and y = ([-\d.]+)", text).groups()
    )
    assert abs(t - start - seconds / 2) < 0.5
    at = int(np.searchsorted(spoilt.t, t))
    assert np.hypot(x - spoilt.values["x"][at], y - spoilt.values["y"][at]) < 0.02


@pytest.mark.parametrize("far", [0.0, 0.1])
@pytest.mark.parametrize("direction", np.arange(4) * np.pi / 2)
def test_a_push_of_a_robot_whose_wheels_slide_in_every_period(direction, far):
    def change(v):
        part = far * np.clip((v["t"] - 8.0) / 0.2, 0, 1)
        slid = 0.03 * np.sin(2 * np.pi * v["t"] / GAIT.period)
        v["x"] = v["x"] + np.cos(direction) * part - np.sin(v["psi"]) * slid
        v["y"] = v["y"] + np.sin(direction) * part + np.cos(v["psi"]) * slid

    pushed = told(recording(change=change))[0] & {"push.robot", "push.surge"}
    assert bool(pushed) == (far > 0)


def test_a_start_from_rest_of_a_robot_that_drives():
    assert told(recording(), start="rest")[0] == {"start.running"}
    assert told(recording(start="rest"), start="rest")[0] == set()


@pytest.mark.parametrize("robot", [ROBOT, None])
def test_the_same_without_a_robot_to_compare_with(robot):
    assert told(recording(), robot=robot, start="rest")[0] == {"start.running"}
    assert told(recording(start="rest"), robot=robot, start="rest")[0] == set()


@pytest.mark.parametrize("periods", [1, 2, 5])
@pytest.mark.parametrize("gait", [GAIT, SineGait(0.6, 1.2, 0.0), SineGait(0.9, 1.1, 0.1)])
def test_a_robot_that_has_driven_for_a_few_periods_does_not_stand(periods, gait):
    def later(v):
        kept = v["t"] >= periods * gait.period - 1e-9
        for name in v:
            v[name] = v[name][kept]
        v["t"] = v["t"] - periods * gait.period

    whole = recording(gait=gait, start="rest")
    assert told(whole, gait=gait, start="rest")[0] == set()
    spoilt = recording(gait=gait, start="rest", change=later)
    codes, text = told(spoilt, gait=gait, start="rest")
    assert codes == {"start.running"}
    at = float(re.search(r"about (-?[\d.]+) mm/s", text)[1]) / 1e3
    seen = spoilt.values
    near = slice(0, 15)
    v0 = np.polyfit(spoilt.t[near], seen["x"][near] * np.cos(seen["psi"][0])
                    + seen["y"][near] * np.sin(seen["psi"][0]), 2)[1]  # fmt: skip
    assert abs(at - v0) < 0.05


@pytest.mark.parametrize("factor", [0.5, 2.0, 1.2])
def test_another_period(factor):
    other = SineGait(GAIT.amplitude, factor * GAIT.period, GAIT.offset)
    codes, text = told(recording(), gait=other)
    assert "command.period" in codes
    assert f"phi repeats every {GAIT.period:.3g} s" in text


def test_a_mirrored_robot_is_half_a_period_off_its_command():
    codes, _ = told(recording(change=scaled(y=-1, psi=-1, phi=-1)))
    assert codes == {"command.half"}


def test_angles_in_degrees_and_lengths_in_millimetres():
    for change, said in (
        (scaled(psi=180 / np.pi), "is psi in degrees?"),
        (scaled(x=1e3, y=1e3), "(millimetres or centimetres?)"),
        (scaled(x=0.01, y=0.01), "x and y are 0.00"),
    ):
        assert said in told(recording(change=change))[1]


def test_a_robot_that_drives_many_lengths_in_a_period_is_right():
    gait, (c1, c2) = SineGait(0.3, 4.0, 0.0), (ROBOT.platform1.c, ROBOT.platform2.c)

    def rolling(v):
        """At 0.5 m/s of axle 1 along platform 1; both axles roll."""
        t, phi = v["t"], gait.angle(v["t"])
        w = -(0.5 * np.sin(phi) + c2 * gait.rate(t)) / (c1 * np.cos(phi) + c2)
        psi = np.cumsum(w) * (t[1] - t[0])
        place = np.cumsum((0.5 - 1j * c1 * w) * np.exp(1j * psi)) * (t[1] - t[0])
        rng = np.random.default_rng(2)
        for name, y in zip(("x", "y", "psi", "phi"), (place.real, place.imag, psi, phi),
                           strict=True):  # fmt: skip
            v[name] = y + NOISE.of(name) * rng.normal(size=len(t))

    fast = recording(gait=gait, change=rolling)
    one = int(gait.period / (fast.t[1] - fast.t[0]))
    assert np.ptp(fast.values["x"][:one]) > 5 * (c1 + c2)
    assert told(fast, gait=gait)[0] == set()


def test_channels_that_are_never_there_together_contradict_nothing():
    def change(v):
        v["x"][::2], v["psi"][1::2] = np.nan, np.nan

    assert told(recording(change=change))[0] <= {"motion.robot"}
