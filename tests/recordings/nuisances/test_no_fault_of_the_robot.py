"""No effect of the robot's physics passes for a nuisance, however strong."""

from dataclasses import replace

import pytest

from rr_opt.effects import CATALOGUE
from rr_opt.machines.racer.racer import RollerRacer
from rr_opt.model.gait import SineGait
from rr_opt.recordings.nuisances import nuisances
from rr_opt.recordings.nuisances.evidence import ExaminedRecording
from tests.sysid.made_up import experiment, predicted, recorded

# What says how phi moves against its command, and is true of these.
OF_THE_SERVO = {"clock.offset", "clock.drift", "command.scale", "command.bias", "motion.robot"}


@pytest.mark.parametrize(
    ("effect", "values"),
    [
        ("servo_lag", {"tau": 0.12}),
        ("servo_rate_limit", {"rate_limit": 1.6}),
        ("servo_backlash", {"width": 0.2}),
        ("servo_offset", {"offset": 0.3}),
        ("clock_offset", {"offset": 0.2}),
        ("marker_offset", {"dx": -0.1, "dy": 0.1}),
        ("marker_offset", {"dx": -0.03, "dy": 0.03}),
        ("marker_offset", {"dx": 0.0, "dy": 0.02}),
        ("marker_offset", {"dx": -0.01, "dy": 0.01}),
        ("lateral_slip", {"creep_compliance": 0.0, "mu": 0.02}),
        ("lateral_slip", {"creep_compliance": 0.3, "mu": 1.0}),
        ("coulomb_friction", {"force1": 0.02, "force2": 0.02}),
        ("axle_misalignment", {"toe1": 0.1, "toe2": -0.1}),
        ("left_right_drag", {"asymmetry1": 0.9, "asymmetry2": -0.9}),
        ("floor_tilt", {"tilt_x": 0.01, "tilt_y": 0.0}),
        ("floor_patch", {"multiplier": 6.0, "x": 0.3, "y": 0.0, "radius": 0.3}),
        ("com_offset", {"d1": 0.03, "d2": -0.03}),
        ("quadratic_drag", {"coefficient_total": 1.0}),
        ("wheel_inertia", {"J": 2e-5}),
    ],
)
def test_none_is_told(effect, values):
    gaits = ((SineGait(0.5, 1.0), "running"), (SineGait(0.4, 1.4, 0.2), "rest"))
    given = experiment(gaits=gaits, seconds=12.0)
    empty = RollerRacer(given)
    neutral = {f"{effect}.{q.name}": q.neutral for q in CATALOGUE[effect].parameters}
    strong = neutral | {f"{effect}.{name}": value for name, value in values.items()}

    def predict(run, start):
        return predicted(empty, run, strong, (effect,), start)

    made = replace(recorded(given, predict, 1).experiment, name=effect)
    for run in made.runs:
        found = nuisances(ExaminedRecording(run.recording, made.robot, run.gait, run.start))
        assert {one.code for one in found} <= OF_THE_SERVO, found
        found = nuisances(ExaminedRecording(run.recording))
        assert {one.code for one in found} <= OF_THE_SERVO, found
