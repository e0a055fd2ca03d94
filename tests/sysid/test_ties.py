"""What predicts about as well as the answer is told, also where that is only suspected."""

from types import SimpleNamespace
from typing import Any

import pytest

from rr_opt.sysid.diagnosis import groups
from rr_opt.sysid.verdict import ties

CATALOGUE = {
    "friction": SimpleNamespace(named=True),
    "drag": SimpleNamespace(named=True),
    "cable": SimpleNamespace(named=False),
}


def result(rival: tuple[str, ...], suspected: tuple[str, ...] = ()) -> Any:
    best = SimpleNamespace(effects=("cable",), advantage=lambda _: (1.0, 0.5))
    return SimpleNamespace(
        best=best,
        rivals=[SimpleNamespace(effects=rival)],
        suspected=suspected,
        selection=SimpleNamespace(model=SimpleNamespace(catalogue=CATALOGUE)),
    )


@pytest.mark.parametrize(
    ("rival", "suspected", "told"),
    [
        (("drag", "friction"), ("cable",), (("cable", "drag", "friction"),)),
        (("drag", "friction"), (), ()),
        (("cable", "drag"), ("cable",), ()),
    ],
)
def test_beside_what_is_suspected(rival, suspected, told):
    assert groups(ties(result(rival, suspected), "unexplained")) == told
