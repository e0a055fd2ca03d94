"""The tables of the page: one scale of misfits, and no two rows that look the same."""

from dataclasses import replace

from rr_opt.documents.document import Badge
from rr_opt.results.diagnosis_tables import candidates_table, parameters_table, stage_text, total
from rr_opt.sysid.diagnosis import Finding, Mismatch, Tried
from tests.robots import DRY


def column(table, name):
    return [row[table.head.index(name)] for row in table.rows]


def test_forms_of_one_effect_are_reported_apart_by_their_parameters(missing):
    disc = {"floor_patch.multiplier": 2.0, "floor_patch.x": 0.1, "floor_patch.radius": 0.2}
    edge = {"floor_patch.multiplier": 2.0, "floor_patch.normal": 0.1}
    tried = tuple(
        Tried(("floor_patch",), 0.1, score, values, False)
        for score, values in ((1.0, disc), (2.0, edge))
    )
    rows = column(candidates_table(replace(missing.found, tried=tried)), "Effects")
    assert rows == ["floor patch (x, radius)", "floor patch (normal)"]


def test_misfits_are_1_for_the_noise_alone(missing):
    assert total(0.0) == 1.0
    assert "1.00 σ" in column(candidates_table(missing.found), "Misfit")


def test_a_stage_explains_a_share_of_the_misfit(missing):
    stage = next(one for one in missing.found.stages if one.guilty)
    found = replace(missing.found, mismatch=Mismatch(2 * stage.size, 0.0))
    assert stage_text(stage, found).startswith("explains 25 %, ")


def test_where_there_is_no_excess_no_share_of_it_is_given(missing):
    stage = replace(missing.found.stages[0], size=0.03, p_value=0.4)
    found = replace(missing.found, mismatch=Mismatch(0.03, 0.4))
    assert stage_text(stage, found) == "p = 0.40"


def test_values_of_effects_that_the_robot_has_are_parameters_of_it(missing, monkeypatch):
    added = parameters_table(missing.found, missing.experiment)
    assert column(added, "Parameter") == ["m1", "kappa1"]
    name = "coulomb_friction.force1"
    wrong = Finding(name, 1.0, {name: missing.found.parameters[name]}, 1.0)
    found = replace(missing.found, verdict="parameters", findings=(wrong,))
    experiment = replace(missing.experiment, robot=DRY)
    rows = {row[1]: list(row[2:]) for row in parameters_table(found, experiment).rows}
    off = Badge("off nominal", "warn")
    assert rows["force1 of Coulomb friction"] == ["2.0 mN", "15.2 mN", "14.1 to 16.3 mN", off]
    assert rows["force2 of Coulomb friction"] == ["2.00 mN", "9.80 mN", "8.90 to 10.70 mN", ""]

    monkeypatch.setattr(type(missing), "loss", None)
    told = replace(missing, found=found, experiment=experiment).document()
    assert "force1 of Coulomb friction" in str(told.sections[1])
