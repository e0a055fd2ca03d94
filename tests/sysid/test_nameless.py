"""Where no name fits, the corrected robot predicts held-out recordings better all the same."""

from dataclasses import replace

from rr_opt.machines.racer.diagnose import diagnose_racer
from rr_opt.machines.racer.racer import RollerRacer
from tests.sysid.made_up import with_effect

NAME = "rolling_force_curve"
FORCES = (0.03, 0.0, 0.03, 0.0, 0.03)
"""N at speeds from 0 to 0.12 m/s: nothing that a law of friction would do."""


def with_second_held_out(model: RollerRacer) -> RollerRacer:
    first, second, *rest = model.experiment.runs
    runs = (first, replace(second, use="holdout"), *rest)
    return RollerRacer(replace(model.experiment, runs=runs))


def test_a_force_over_speed_that_has_no_name():
    values = {f"{NAME}.force{k}": force for k, force in enumerate(FORCES)} | {f"{NAME}.speed": 0.12}
    found = diagnose_racer(with_second_held_out(with_effect(values, (NAME,))))
    assert found.verdict == "unexplained"
    assert not found.findings
    assert found.after < 0.7 * found.before
    assert any(name.startswith(f"{NAME}.force") for name in found.values)
