"""Whatever an experiment file holds, reading it gives a plan or an InvalidFileError."""

from __future__ import annotations

from contextlib import suppress

import yaml
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from rr_opt.files.experiment_file import named_files, read_plan
from rr_opt.files.experiment_model import (
    ExperimentModel,
    MarkersModel,
    RecordingModel,
    UncertaintyModel,
)
from rr_opt.files.fields import keys_of
from rr_opt.files.issue import InvalidFileError
from rr_opt.files.lint import lint_file
from rr_opt.files.record import FourierRecord, SineRecord
from rr_opt.model.experiment import CountScale, Noise

MODELS = (
    *(ExperimentModel, keys_of(Noise), MarkersModel, keys_of(CountScale), RecordingModel),
    *(UncertaintyModel, SineRecord, FourierRecord),
)
KEYS = sorted({key for model in MODELS for key in model.model_fields})
GOOD = yaml.safe_load("""
robot:
  platform1: {m: 0.4, I: 0.002, c: 0.2, a: 0.02, b: 0.05, kappa: 2.0e-5}
  platform2: {m: 0.3, I: 0.001, c: 0.1, a: -0.01, b: 0.05, kappa: 3.0e-5}
  h: 20 mm
noise: {position: 1 mm, angle: 3 mrad}
uncertainty: {m: 1 %, kappa: unknown}
recordings:
- {file: one.csv, gait: {amplitude: 0.5, period: 1 s, offset: 0}, use: fit, start: rest}
markers:
  platform1: {A: [40 mm, 0], B: [0.2, 0.1, 0.01]}
  platform2: {C: [-40 mm, 0], D: [-0.2, 0.1]}
servo_counts: {counts: 4096, range: -360 deg, zero: 2048}
""")
WORDS = st.sampled_from(["unknown", "5 %", "2 mm", "fit", "rest", "one.csv", ".", "-y", ""])
VALUES = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=8) | WORDS,
    lambda inner: (
        st.lists(inner, max_size=3)
        | st.dictionaries(st.sampled_from(KEYS) | st.text(max_size=5), inner, max_size=5)
    ),
    max_leaves=15,
)
FUZZ = settings(
    deadline=None, max_examples=60, suppress_health_check=[HealthCheck.function_scoped_fixture]
)


def read_all_ways(tmp_path, data):
    (tmp_path / "one.csv").write_text("")
    path = tmp_path / "experiment.yaml"
    path.write_text(yaml.safe_dump(data, allow_unicode=True), encoding="utf-8")
    "\n".join(map(str, lint_file(path))).encode()
    named_files(path)
    with suppress(InvalidFileError):
        plan, _ = read_plan(path)
        assert plan.runs
        assert plan.sha256


@FUZZ
@given(
    data=st.dictionaries(st.sampled_from(list(ExperimentModel.model_fields)), VALUES, max_size=6)
)
def test_any_values_under_known_keys(tmp_path, data):
    read_all_ways(tmp_path, data)


@FUZZ
@given(place=st.integers(0, 200), value=VALUES)
def test_any_value_in_a_good_file(tmp_path, place, value):
    def replaced(node, left):
        """The same with the left-th value in it replaced, and how many values it has."""
        if left == 0:
            return value, 1
        if not isinstance(node, dict | list):
            return node, 1
        pairs = node.items() if isinstance(node, dict) else enumerate(node)
        made, seen = [], 1
        for key, inner in pairs:
            new, count = replaced(inner, left - seen)
            made.append((key, new))
            seen += count
        return (dict(made) if isinstance(node, dict) else [one for _, one in made]), seen

    _, count = replaced(GOOD, -1)
    data, _ = replaced(GOOD, 1 + place % (count - 1))
    read_all_ways(tmp_path, data)


def test_the_file_is_good_before_it_is_spoiled(tmp_path):
    read_all_ways(tmp_path, GOOD)
    assert read_plan(tmp_path)[0].markers is not None
