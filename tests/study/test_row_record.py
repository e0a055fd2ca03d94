"""A row survives JSON, and a record that is not one of a row says what is wrong with it."""

import copy
import json
import random

import pytest

from rr_opt.design.study.row import gait_from, gait_record, row_from, row_record
from rr_opt.model.gait import FourierGait, FreeGait, SineGait

STUDY = """
problem:
  gait: {amplitude: [0.1, 1.0], period: 1 s, offset: 0.0}
vary:
  limits.rate: [0.1 rpm, 20 rpm]
"""


@pytest.fixture
def rows(study_of, solved):
    return solved(study_of(STUDY))


def test_through_json_and_back(rows):
    for row in rows.values():
        assert row_from(json.loads(json.dumps(row_record(row)))) == row


def test_what_is_no_row_is_refused(rows):
    infeasible, optimal = (json.loads(json.dumps(row_record(rows[case]))) for case in (0, 1))
    assert optimal["optimum"]
    assert not infeasible["optimum"]

    def refused(record, words, *path, value=None):
        changed = copy.deepcopy(record)
        *above, last = path
        place = changed
        for key in above:
            place = place[key]
        if value is None:
            del place[last]
        else:
            place[last] = value
        with pytest.raises((KeyError, TypeError, ValueError), match=words):
            row_from(changed)

    for record in (infeasible, optimal):
        for key in record:
            refused(record, key, key)
        refused(record, "done", "status", value="done")
        refused(record, "hot", "started", value="hot")
        refused(record, "seconds", "seconds", value=float("nan"))
        refused(record, "unexpected", "unexpected", value=1)
    for key in optimal["optimum"]:
        refused(optimal, key, "optimum", key)
    refused(optimal, "speed", "optimum", "speed", value="fast")
    refused(optimal, "speed", "optimum", "speed", value=True)
    refused(optimal, "radius", "optimum", "radius", value="wide")
    refused(optimal, "prices", "optimum", "prices", "rate", value="much")
    refused(optimal, "square", "optimum", "gait", "shape", value="square")
    refused(optimal, "offset", "optimum", "gait", "offset")
    refused(optimal, "amplitude", "optimum", "gait", "amplitude", value="large")
    refused(optimal, "does not fit", "status", value="infeasible")
    refused(infeasible, "does not fit", "status", value="optimal")


@pytest.mark.parametrize(
    "gait",
    [
        SineGait(0.3, 1.0, 0.1),
        FourierGait(1.0, 0.1, (0.3, 0.1), (0.0, 0.2)),
        FreeGait(1.0, 0.1, 0.2, (1.0, -1.0)),
    ],
)
def test_gaits_of_every_shape(gait):
    assert gait_from(json.loads(json.dumps(gait_record(gait)))) == gait


VALUES = (None, True, 0, -1, 0.7, 1e308, 10**400, "", "x", "9" * 500, [], [1], ["a"], {}, {"a": {}})


def places(record, above=()):
    """The path of every value within a record."""
    items = record.items() if isinstance(record, dict) else enumerate(record)
    for key, value in items:
        yield (*above, key)
        if isinstance(value, (dict, list)):
            yield from places(value, (*above, key))


def test_whatever_is_wrong_in_a_row_is_said_in_a_sentence(rows):
    rng, said = random.Random(11), []
    records = [json.loads(json.dumps(row_record(row))) for row in rows.values()]
    for _ in range(1500):
        changed = copy.deepcopy(rng.choice(records))
        *above, last = rng.choice(list(places(changed)))
        place = changed
        for key in above:
            place = place[key]
        place[last] = rng.choice(VALUES)
        try:
            row = row_from(changed)
        except (KeyError, TypeError, ValueError) as error:
            said.append(str(error))
        else:
            # What is accepted is a row that can be written again.
            assert json.loads(json.dumps(row_record(row), allow_nan=False)) == changed
    assert all(0 < len(sentence) < 200 for sentence in said)
    assert len(said) > 1000
