"""What the audit states in fixed words is true, and no number in it is missing."""

import math

from rr_opt.outcome import Status
from rr_paper.publication import ANGLE_LIMIT
from rr_paper.reproduction import findings
from rr_paper.signs import CORRECTED


def test_signs(found):
    audit = found.signs
    for one in audit.deviations:
        right = one.signs is CORRECTED
        assert one.kane < 1e-9 if right else one.median > 0.01
        assert one.multipliers < 1e-9 if right else one.multipliers > 0.1
    assert audit.torque < 1e-9
    to_multipliers, to_corrected, to_printed = audit.comparison.distance
    assert max(to_multipliers, to_corrected) < 1e-6
    assert to_printed > 0.1


def test_readings(found):
    audit = found.consistency
    assert all(one.p > 0.05 for one in audit.of("ratio", "mean"))
    assert audit.of("kappa", "mean")[-1].p < 0.01
    reached = {one.definition.name: one.reached for one in audit.unloaded}
    assert reached["about the centres of mass"] == reached["about the axles' centres"] == ()
    assert 0.08 not in reached["about P, by platform 2's inertia"]
    assert 0.14 in reached["about P, by platform 2's inertia"]
    pairs = zip(audit.of("ratio", "mean"), audit.of("ratio", "other"), strict=True)
    assert all(mean.fit.chi2 < other.fit.chi2 for mean, other in pairs)


def test_columns_and_limits(found):
    assert all(one.columns_agree for one in found.tables.rows)
    over = {one.where for one in found.demands if one.excess}
    assert {"Table 3, row 2", "Table 3, row 3", "Fig. 6"} <= over
    assert found.posture.largest < ANGLE_LIMIT


def test_period(found):
    law = found.period
    assert all(one.low <= 4.0 <= one.high for one in law.ratios)
    assert max(one.largest for one in law.spreads) < sorted(one.other for one in law.ratios)[1]


def test_best_amplitude(found):
    limited, unlimited = found.best.limited, found.best.unlimited
    assert limited.status is Status.OPTIMAL
    assert unlimited.status is Status.OPTIMAL
    assert limited.optimum.best.gait.amplitude <= 0.5 * limited.optimum.best.gait.period * 1.0001
    assert unlimited.optimum.best.gait.amplitude > 1.19


def test_turning(found):
    assert found.turning.sides_hold
    assert found.turning.radii_hold
    assert not found.turning.sign.holds
    assert not found.turning.radius.holds


def test_every_number_is_one(found):
    for section in findings(found):
        assert "nan" not in " ".join(section.sentences)
        for row in section.table.rows:
            assert len(row) == len(section.table.head)
            assert not any(isinstance(cell, float) and math.isnan(cell) for cell in row)
