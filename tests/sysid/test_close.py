"""What an answer leaves may be its effects' form error; the nominal model has none."""

from types import SimpleNamespace
from typing import Any

import pytest

from rr_opt.sysid.selection import Selection


@pytest.mark.parametrize(
    ("effects", "left", "first", "within"),
    [
        ((), 0.0, 0.0, False),
        ((), 0.0, 5.0, False),
        (("slip",), 0.4, 5.0, True),
        (("slip", "lag"), 0.9, 10.0, True),
        (("lag",), 0.4, 5.0, False),
    ],
)
def test_which_misfits_are_within_the_form_error(effects, left, first, within):
    search: Any = SimpleNamespace(base=SimpleNamespace(excess=first))
    known = {"slip": 0.1, "lag": 0.02}
    one: Any = SimpleNamespace(form_errors={name: known[name] for name in effects}, excess=left)
    assert Selection._close(search, one) is within
