"""What is suspected is told everywhere, but not among the effects."""

from dataclasses import replace

import pytest

from rr_opt.results import diagnosis_tables as tables


@pytest.fixture(scope="module")
def suspected(every):
    one = every["unexplained"]
    (finding,) = every["missing_physics"].found.findings
    suspect = replace(finding, name="dragged_cable", confidence=0.87)
    return replace(one, found=replace(one.found, suspects=(suspect,)))


def test_headline(suspected):
    assert tables.headline(suspected.found) == "Physics is missing; a dragged cable is suspected"
    both = replace(suspected.found, suspects=suspected.found.suspects * 2)
    assert tables.headline(both).endswith("cable and a dragged cable are suspected")


def test_record(suspected):
    record = suspected.record()
    assert record["verdict"] == "unexplained"
    assert record["effects"] == []
    (suspect,) = record["suspects"]
    assert (suspect["name"], suspect["confidence"]) == ("dragged_cable", 0.87)
    assert suspect["parameters"]["force1"]["ci95"] == [0.0141, 0.0163]


def test_words(suspected):
    assert "dragged cable, suspected" in str(tables.effects_table(suspected.found))
    assert "suspected, confidence 0.87" in suspected.summary()
