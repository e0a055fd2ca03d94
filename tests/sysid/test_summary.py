"""The answer's first sentence tells whether values had to move for the model to explain."""

from dataclasses import dataclass
from typing import Any

import pytest

from rr_opt.sysid.diagnose import summary_of


@dataclass
class Off:
    """Stands for a level: by so much it is off, in sigma, with no recording held out."""

    sigma: float
    misfits = ()

    def unseen(self):
        return self.sigma


@pytest.mark.parametrize(("before", "says"), [(1.001, "as it is."), (8.0, "with values within")])
def test_a_consistent_model_is_told_as_it_is_only_if_it_was_right_before(before, says):
    levels: Any = Off(before), Off(1.0)
    told = summary_of("consistent", (), *levels)
    assert told.startswith("The model explains the recordings")
    assert says in told.split(". ")[0] + "."
