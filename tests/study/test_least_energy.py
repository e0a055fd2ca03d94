"""The case with the least energy has the least energy per metre, whatever the robots weigh."""

from rr_opt.design.study.row import CaseOptimum, Row
from rr_opt.outcome import Status
from rr_opt.results.study import SolvedStudy


def row(energy, cost):
    optimum = CaseOptimum(
        gait={"shape": "sine", "amplitude": 0.5, "period": 1.0, "offset": 0.0},
        sign=1,
        share=0.0,
        speed=0.1,
        amplitude=0.5,
        period=1.0,
        offset=0.0,
        ratio=0.3,
        cycle_length=0.1,
        turn=0.0,
        radius=None,
        peak_angle=0.5,
        peak_rate=3.0,
        peak_torque=0.1,
        least_s1=0.1,
        peak_grip=0.1,
        energy_per_metre=energy,
        net_energy_per_metre=energy,
        cost_of_transport=cost,
        held=(),
        prices={},
        bound_prices={},
    )
    return Row(Status.OPTIMAL, "", optimum)


def test_a_heavy_robot_has_a_low_cost_of_transport_but_not_the_least_energy(study_of):
    study = study_of("vary: {robot.platform1.m: [0.4, 0.8]}\n")
    result = SolvedStudy(study, (row(1.0, 0.3), row(1.2, 0.2)))
    told = str(result.document().sections[1])
    assert "1 J/m" in told
    assert "1.2 J/m" not in told
