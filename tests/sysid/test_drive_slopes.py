"""A run's linearisation by the servo's faults and the clock is right to six per cent.

Held against differences of whole simulations, from rest, recorded before the start too, and
running, where dphi jumps as well.
"""

import numpy as np
import pytest

from rr_opt.effects import CATALOGUE
from rr_opt.machines.racer.drive import Drives, drive_path, drive_slopes, grain, steps_of
from rr_opt.machines.racer.racer import RollerRacer
from rr_opt.model.experiment import CHANNELS, Experiment, Noise, Recording, Run, Uncertainty
from rr_opt.model.gait import SineGait
from rr_opt.sysid.model import Request
from tests.robots import BENCHMARK
from tests.sysid.made_up import whole

GAIT = SineGait(0.6, 1.0, 0.1)
NOISE = Noise(1e-3, 3e-3)
FAULTS = {
    "servo_rate_limit.rate_limit": (0.7 * GAIT.peak_rate, 3e-3),
    "servo_backlash.width": (0.02, 2e-4),
    "servo_lag.tau": (0.03, 1e-4),
    "servo_offset.offset": (0.01, 1e-4),
    "clock_offset.offset": (0.01, 1e-4),
}


def racer(start, before) -> RollerRacer:
    t = np.linspace(-before, 3.0 - before, 301)
    still = {name: np.zeros(t.size) for name in CHANNELS}
    sigma = {name: np.full(t.size, NOISE.of(name)) for name in CHANNELS}
    flags = {name: np.zeros(t.size, np.uint8) for name in CHANNELS}
    run = Run(Recording("run", t, still, sigma, flags), GAIT, "fit", start)
    return RollerRacer(Experiment(BENCHMARK, NOISE, {"m1": Uncertainty(0.01)}, (run,), "made up"))


@pytest.mark.parametrize("before", [0.3, 0.3031, 0.3069])
def test_where_wheels_slip_the_rate_amounts_to_the_angle(before):
    """A start from rest is spread over the steps around it."""
    model, effects = racer("rest", before), ("clock_offset", "lateral_slip")
    given = {**model.nominal, "clock_offset.offset": 0.0}
    given |= {f"lateral_slip.{q.name}": q.neutral for q in CATALOGUE["lateral_slip"].parameters}
    t = model.runs[0].t
    drives = Drives(model.experiment.runs)
    slopes = drive_slopes(drives, 0, t, given, effects, ("clock_offset.offset",))
    assert slopes is not None
    drive = drives.of(0, given, effects)
    h = drive_path(drive, steps_of(drive, t, 0.0, **grain(given, effects)), 0.0).h
    turned = np.sum(slopes.middle[1, :, 0] * h)
    assert turned == pytest.approx(slopes.at[0, -1, 0] - slopes.at[0, 0, 0], rel=1e-3)


@pytest.mark.parametrize(
    ("start", "before"),
    [("rest", 0.0), ("rest", 0.5), ("rest", 0.4937), ("rest", 0.49), ("running", 0.0)],
)
@pytest.mark.parametrize("name", FAULTS)
def test_against_differences(name, start, before):
    model, effects, (value, step) = racer(start, before), (name.split(".")[0],), FAULTS[name]
    begin, segment = np.array([0.0, 0.0, 0.3, 0.05]), whole(model, 0)
    (found,) = model.linearise([Request(segment, {name: value}, begin)], effects, (name,))
    here, up, down = model.simulate(
        [Request(segment, {name: value + way * step}, begin) for way in (0, 1, -1)], effects
    )
    slope = ((up.residuals - down.residuals) / (2 * step)).ravel()
    k = begin.size
    assert found.gram[k, k] == pytest.approx(slope @ slope, rel=0.1)
    # Nothing of it is along anything else: the cosine between the two is that of six per cent.
    r = here.residuals.ravel()
    bound = 0.06 * np.linalg.norm(slope) * np.linalg.norm(r)
    assert found.gram[k, -1] == pytest.approx(slope @ r, abs=bound)
    end = (up.end - down.end) / (2 * step)
    assert np.abs(found.end[:, k] - end).max() <= 0.06 * np.abs(end).max()
