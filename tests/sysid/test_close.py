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
    catalogue = {"slip": SimpleNamespace(form_error=0.1), "lag": SimpleNamespace(form_error=0.02)}
    search: Any = SimpleNamespace(
        model=SimpleNamespace(catalogue=catalogue), base=SimpleNamespace(excess=first)
    )
    assert Selection._close(search, SimpleNamespace(effects=effects, excess=left)) is within
