"""The files of a trial have the same counts, and lead to the page of every miss."""

import csv
import json

import pytest

from rr_lab.report import Proof
from rr_lab.trial import OpenedTrial
from tests.rr_lab_trial.made_up import case, said, single, truth

DRAG, SLIP = "quadratic_drag", "lateral_slip"
VALUES = {DRAG: {"coefficient_total": 0.5}}
CASES = (
    case(truth("null"), said("consistent", before=1.0, after=1.0), "001"),
    case(truth("null", engine="planar"), said("parameters", "m1"), "002"),
    case(
        truth("single", DRAG, values=VALUES),
        said(
            "missing_physics",
            DRAG,
            intervals={DRAG: {"coefficient_total": (0.4, 0.6)}},
            remainder="small",
            share=0.25,
        ),
        "003",
    ),
    case(truth("single", DRAG), None, "004", why_none="no answer after 1800 s"),
    case(
        truth("outside", "tether", values={"unknown": {"slack": 0.1}}), said("unexplained"), "005"
    ),
    case(truth("pair", DRAG, SLIP), said("missing_physics", SLIP), "006"),
    case(truth("parameters", "m1", values={"m1": {"m1": 0.5}}), said("parameters", "m1"), "007"),
)
OPENED = OpenedTrial("5eed", "c0de", "1.2.3", CASES, {"008": "MuJoCo gave up."}, (10.0,) * 7)
MISSES = {"002": "report.html", "004": "output.txt", "006": "report.html"}


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    place = tmp_path_factory.mktemp("proof")
    Proof(OPENED).save(place)
    return place


def test_the_record(folder):
    record = json.loads((folder / "proof.json").read_text())
    assert record["seed"] == "5eed"
    assert record["measures"]["single"]["count"] == 1
    assert record["measures"]["single"]["total"] == 2
    assert record["measures"]["false_claims"]["fraction"] == 0.5
    assert record["coverage"]["all"]["count"] == 1
    assert record["not_made"] == {"008": "MuJoCo gave up."}
    rows, columns = record["confusion"]["rows"], record["confusion"]["columns"]
    counts = record["confusion"]["counts"]
    assert counts[rows.index(DRAG)][columns.index("no answer")] == 1


def test_what_the_diagnosis_says_is_left(folder):
    left = json.loads((folder / "proof.json").read_text())["remainder"]["kinds"]
    assert left == {"single": {"none": 0, "small": 1, "large": 0, "share": 0.25}}
    with (folder / "cases.csv").open(newline="") as file:
        rows = [(row["remainder"], row["remainder_share"]) for row in csv.DictReader(file)]
    assert [row for row in rows if row[0]] == [("small", "0.25")]
    assert "## Remainder" in (folder / "README.md").read_text()


def test_every_miss_is_listed_with_its_page(folder):
    record = json.loads((folder / "proof.json").read_text())["misses"]
    pages = {case: f"said/{case}/{name}" for case, name in MISSES.items()}
    assert {miss["case"]: miss["page"] for miss in record} == pages
    text, html = ((folder / name).read_text() for name in ("README.md", "report.html"))
    for number, page in pages.items():
        assert f"\n| {number}  |" in text
        assert page in html


def test_each_engine_is_counted(folder):
    record = json.loads((folder / "proof.json").read_text())
    assert record["engines"]["planar"]["false_claims"]["count"] == 1
    assert record["engines"]["mujoco"]["false_claims"]["count"] == 0
    assert record["misses"][0]["engine"] == "planar"
    with (folder / "cases.csv").open(newline="") as file:
        rows = [row["engine"] for row in csv.DictReader(file)]
    assert rows == ["mujoco", "planar", *["mujoco"] * 5]
    assert "## By engine" in (folder / "README.md").read_text()
    assert "<h2>By engine</h2>" in (folder / "report.html").read_text()
    assert ">planar</" in (folder / "report.html").read_text()


def test_the_table_has_a_row_a_case(folder):
    with (folder / "cases.csv").open(newline="") as file:
        rows = list(csv.DictReader(file))
    assert [row["case"] for row in rows] == [case.id for case in CASES]
    assert [row["case"] for row in rows if row["missed"] == "yes"] == list(MISSES)
    assert rows[4]["hidden"] == "tether (slack 0.1)"
    assert rows[2]["outcome"] == "right"


def test_the_summary_defines_what_it_counts(folder):
    text = (folder / "README.md").read_text()
    assert Proof(OPENED).summary().startswith(text[2:20])
    assert text.startswith("# Blind trial: 1 of 2 single effects named, 1 of 2 nulls with a false")
    assert "50 % (1 to 99)" in text
    assert "verdict is not `consistent`" in text
    assert "what the diagnosis named in columns](confusion.svg)" in text


def test_a_trial_of_one_kind(tmp_path):
    Proof(OpenedTrial("5eed", "c0de", "1.2.3", (single(DRAG, None),), {}, (1.0,))).save(tmp_path)
    assert "0 of 1 single effects named" in (tmp_path / "README.md").read_text()
