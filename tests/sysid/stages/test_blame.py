"""To blame is the first stage that explains as much as the best, and no small fault before it."""

import numpy as np
import pytest

from rr_opt.machines.racer.stages.found import blame
from rr_opt.machines.racer.stages.gram import Gram, products

COUNT = 40000
NAMES = ("first", "second", "third")


def gram(strength: tuple[float, float, float], alike: float, seed: int) -> Gram:
    """Three stages of two columns each; the first is like the second to a degree."""
    rng = np.random.default_rng(seed)
    own = [rng.normal(size=(COUNT, 2)) for _ in NAMES]
    own[0] = alike * own[1] + (1 - alike**2) ** 0.5 * own[0]
    r = rng.normal(size=COUNT) + sum(k * part[:, 0] for k, part in zip(strength, own, strict=True))
    blocks = {name: slice(2 * i, 2 * i + 2) for i, name in enumerate(NAMES)}
    S = products(np.zeros((COUNT, 0)), np.column_stack([*own, r]))
    return Gram(S, blocks, (), COUNT)


@pytest.mark.parametrize("seed", range(5))
@pytest.mark.parametrize(
    ("strength", "alike", "guilty"),
    [
        ((0.5, 0.0, 0.0), 0.0, "first"),
        ((0.0, 0.0, 0.5), 0.0, "third"),
        # What looks like the first is the second, if that is clearly better.
        ((0.0, 0.5, 0.0), 0.99, "second"),
        # Where both do as well, it is the first.
        ((0.0, 0.5, 0.0), 0.99999, "first"),
        # Of two faults of a size it is the first, but a small one does not count.
        ((0.5, 0.0, 0.5), 0.0, "first"),
        ((0.15, 0.0, 1.0), 0.0, "third"),
        ((0.0, 0.0, 0.0), 0.0, ""),
    ],
)
def test_who_is_to_blame(strength, alike, guilty, seed):
    own = gram(strength, alike, seed)
    assert blame(own, NAMES, 0.001, wrong=True).guilty == guilty
