"""What the tests of studies share: studies as files, solved in this process."""

from pathlib import Path

import pytest

from rr_opt.design.study.case import solve_case, solve_study
from rr_opt.design.study.plan import plan
from rr_opt.files.study_file import read_study


def serial(tasks):
    """Solves tasks one after another, here."""
    return ((case, solve_case(task)) for case, task in tasks.items())


@pytest.fixture
def study_of(tmp_path):
    """A study from its YAML text."""

    def made(text: str):
        path = Path(tmp_path) / "study.yaml"
        path.write_text(text)
        return read_study(path)[0]

    return made


@pytest.fixture
def solved():
    """All rows of a study, by case."""

    def made(study, *, cold: bool = False):
        planned = plan([axis.numbers for axis in study.axes], study.shape)
        return dict(solve_study(study.problems, planned, {}, serial, cold=cold))

    return made
