"""The strip lights what the diagnosis lights, and hides nothing that a stage's test saw."""

from dataclasses import replace

from rr_opt.results.diagnosis import chain_note
from rr_opt.results.diagnosis_tables import stage_words


def test_a_stage_that_is_not_lit_but_sees_something_is_not_called_clear(missing):
    stages = list(missing.found.stages)
    stages[0] = replace(stages[0], p_value=1e-6, size=0.5)
    assert stage_words(stages)[0] == "affected"
    # Certain and too small to matter, or large and by chance: neither counts.
    for p, size in ((1e-6, 0.05), (0.2, 0.5)):
        stages[0] = replace(stages[0], p_value=p, size=size)
        assert stage_words(stages)[0] == "clear"


def test_what_the_diagnosis_says_of_the_place_is_under_the_strip_whether_or_not_one_is_lit(missing):
    where = "The tests point elsewhere."
    found = replace(missing.found, where=where)
    dark = tuple(replace(stage, guilty=False) for stage in found.stages)
    lit = chain_note(replace(missing, found=found))
    unlit = chain_note(replace(missing, found=replace(found, stages=dark, verdict="consistent")))
    assert f"{where} Highlighted: " in lit
    assert where in unlit
    assert "Highlighted:" not in unlit
    assert ".." not in lit
