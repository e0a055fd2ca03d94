"""Whatever a file holds, reading it gives a problem or an InvalidFileError, nothing else."""

from __future__ import annotations

from contextlib import suppress
from pathlib import Path

import pytest
import yaml
from hypothesis import HealthCheck, example, given, settings
from hypothesis import strategies as st

from rr_opt.files.fields import keys_of
from rr_opt.files.issue import InvalidFileError
from rr_opt.files.lint import lint_file
from rr_opt.files.problem_file import ProblemModel, read_problem
from rr_opt.files.robot_file import PlatformModel, RobotModel, read_robot
from rr_opt.files.source import SHIPPED
from rr_opt.model.problem import GaitBounds, Limits, RatioChoice
from rr_opt.model.robot import Servo

MODELS = (
    *(ProblemModel, keys_of(GaitBounds), keys_of(RatioChoice), keys_of(Limits)),
    *(RobotModel, PlatformModel, keys_of(Servo)),
)
KEYS = sorted({key for model in MODELS for key in model.model_fields})
WORDS = st.sampled_from(["sine", "joint", "loads", "30 rpm", "1 mm", ".inf", "measured", "F1"])
VALUES = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=8) | WORDS,
    lambda inner: (
        st.lists(inner, max_size=3)
        | st.dictionaries(st.sampled_from(KEYS) | st.text(max_size=5), inner, max_size=5)
    ),
    max_leaves=20,
)
SHIPPED_LINES = [
    line
    for name in ("robot", "problem")
    for line in (SHIPPED / f"{name}.yaml").read_text().splitlines()
]
FUZZ = settings(
    deadline=None, max_examples=30, suppress_health_check=[HealthCheck.function_scoped_fixture]
)


def read_all_ways(path: Path, content: bytes) -> None:
    path.write_bytes(content)
    issues = lint_file(path)
    "\n".join(map(str, issues)).encode()
    for read in (read_problem, read_robot):
        with suppress(InvalidFileError):
            read(path)


@FUZZ
@given(text=st.text(max_size=200))
def test_any_text(tmp_path: Path, text: str):
    read_all_ways(tmp_path / "f.yaml", text.encode())


@FUZZ
@given(content=st.binary(max_size=100))
def test_any_bytes(tmp_path: Path, content: bytes):
    read_all_ways(tmp_path / "f.yaml", content)


@FUZZ
@given(text=st.text(alphabet="ab:{}[]-&*!|>'\"%@#?, \n\t01.", max_size=60))
def test_punctuation(tmp_path: Path, text: str):
    read_all_ways(tmp_path / "f.yaml", text.encode())


@FUZZ
@given(data=st.dictionaries(st.sampled_from(KEYS), VALUES, max_size=6))
def test_any_values_under_known_keys(tmp_path: Path, data: dict[str, object]):
    read_all_ways(tmp_path / "f.yaml", yaml.safe_dump(data, allow_unicode=True).encode())


@FUZZ
@given(lines=st.lists(st.sampled_from(SHIPPED_LINES), max_size=25))
def test_lines_of_the_shipped_files_in_any_order(tmp_path: Path, lines: list[str]):
    read_all_ways(tmp_path / "f.yaml", "\n".join(lines).encode())


@FUZZ
@given(key=st.sampled_from(["m", "I", "c", "a", "b", "kappa"]), value=VALUES)
@example(key="c", value=1e200)
def test_any_value_in_a_platform(tmp_path: Path, key: str, value: object):
    data = yaml.safe_load((SHIPPED / "robot.yaml").read_text())
    data["platform1"][key] = value
    read_all_ways(tmp_path / "f.yaml", yaml.safe_dump(data, allow_unicode=True).encode())


@pytest.mark.parametrize("name", ["", ".", "a\0b", "x" * 5000, "/nowhere/at/all"])
def test_any_path(name: str):
    assert lint_file(name)
