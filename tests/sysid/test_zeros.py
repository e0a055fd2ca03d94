"""Zeros of psi and phi that may be off are fitted, within what the experiment says of them."""

from dataclasses import replace

import pytest

from rr_opt.machines.racer.racer import RollerRacer
from rr_opt.model.experiment import Uncertainty
from rr_opt.sysid.diagnose import diagnose
from tests.sysid.made_up import with_effect

OFF = {"psi": 0.02, "phi": -0.012}


def off(**known) -> RollerRacer:
    """A robot as believed, recorded from zeros that are off by so much."""
    plain = with_effect({}, ()).experiment
    runs = []
    for run in plain.runs:
        values = {
            name: column + OFF.get(name, 0.0) for name, column in run.recording.values.items()
        }
        runs.append(replace(run, recording=replace(run.recording, values=values)))
    uncertainty = {**plain.uncertainty, **{k: Uncertainty(sigma) for k, sigma in known.items()}}
    return RollerRacer(replace(plain, runs=tuple(runs), uncertainty=uncertainty))


def test_within_what_is_said_of_them_nothing_is_missing():
    found = diagnose(off(psi_zero=0.02, phi_zero=0.02))
    assert found.verdict == "consistent"
    for name, true in OFF.items():
        one = found.parameters[f"{name}_zero"]
        assert one.value == pytest.approx(true, abs=1e-3)
        # Three sigmas and not two: of several seeds one misses the 95 %.
        assert abs(one.value - true) < 1.5 * (one.high - one.low) / 2


def test_beyond_it_they_are_the_values_that_are_wrong():
    found = diagnose(off(psi_zero=0.003, phi_zero=0.001))
    assert found.verdict == "parameters"
    assert {one.name for one in found.findings} == {"psi_zero", "phi_zero"}


def test_exact_unless_something_is_said_of_them():
    found = diagnose(off())
    assert found.verdict in ("missing_physics", "unexplained")
    assert not any(name.endswith("_zero") for name in found.parameters)
