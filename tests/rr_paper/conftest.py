"""The whole reproduction, shared by the tests, with less effort where it repeats itself."""

import pytest

from rr_opt.files.problem_file import read_problem
from rr_paper import consistency, statements
from rr_paper.reproduction import Reproduction, reproduce


@pytest.fixture(scope="session")
def found() -> Reproduction:
    with pytest.MonkeyPatch.context() as less:
        less.setattr(consistency, "_SCREENED", 80)
        less.setattr(consistency, "_STARTS", 1)
        less.setattr(statements, "_PEAK_ROBOTS", 5)
        less.setattr(statements, "_ROBOTS", 100)
        return reproduce(read_problem(None), lambda _: None)
