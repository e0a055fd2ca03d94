"""Continuing neighbours' optima finds what cold starts find, where the branch changes too."""

import pytest

from rr_opt.design.study.plan import branches, plan

JUMP = """
vary:
  inertia_ratio: {from: 0.07, to: 0.13, count: 7}
"""
KINKS = """
problem:
  gait: {amplitude: [0.1, 1.0], period: [0.4, 2.0]}
vary:
  limits.rate: {from: 20 rpm, to: 80 rpm, count: 5}
  limits.torque: {from: 0.05, to: 0.5, count: 4, spacing: log}
"""


@pytest.mark.parametrize("text", [JUMP, KINKS], ids=["jump", "kinks"])
def test_same_speeds(study_of, solved, text):
    study = study_of(text)
    warm, cold = solved(study), solved(study, cold=True)
    assert {row.started for row in cold.values()} == {"cold"}
    assert any(row.continued for row in warm.values())
    for case, row in cold.items():
        assert warm[case].optimum.speed == pytest.approx(row.optimum.speed, rel=1e-6)


def test_the_jump_parts_two_branches(study_of, solved):
    study = study_of(JUMP)
    rows = solved(study)
    numbers = branches([rows[case] for case in range(7)], plan([range(7)], [7]).adjacent)
    forward = [rows[case].optimum.speed > 0 for case in range(7)]
    assert forward[0]
    assert not forward[-1]
    assert numbers == [1 if one else 2 for one in forward]
