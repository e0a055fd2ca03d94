"""What each case of a trial is, by lot from the trial's seed and the case's number.

Kinds come in blocks of fixed composition, shuffled, so that a case depends on nothing but seed,
kinds and its own number: a trial can be made longer, and one case can be made again by itself.
"""

from __future__ import annotations

import hashlib
from dataclasses import dataclass
from typing import TypeVar

import numpy as np

from rr_opt.lab.engines import ENGINES, Engine
from rr_opt.lab.random_case import KINDS, NAMED, STRANGE
from rr_opt.lab.streams import stream
from rr_opt.outcome import InputError

BLOCK = {"null": 5, "single": 9, "pair": 2, "parameters": 2, "outside": 2}
"""How many of each kind there are in a block of twenty."""

STRENGTHS = {"faint": (2.0, 5.0), "medium": (5.0, 15.0), "strong": (15.0, 40.0)}
"""RMS deviation from the nominal robot's run, sigma of the noise; drawn evenly in its logarithm."""

# Wheel inertia is a change of parameters in disguise; the laboratory's own lots leave it out too.
SINGLES = tuple(name for name in NAMED if name != "wheel_inertia")

_BITS = 48
_Name = TypeVar("_Name")


@dataclass(frozen=True)
class Lot:
    """What a case is made from.

    kind    as `random_case` takes it: null, parameters, pair, single:EFFECT, outside:EFFECT
    target  visibility of a single effect, sigma; None: drawn by the laboratory
    spread  0: the nominal values are true; 1: they are off by chance, as their uncertainties say
    seed    the case's own
    engine  what drives it
    """

    number: int
    kind: str
    target: float | None
    spread: float
    seed: int
    engine: Engine = "mujoco"

    @property
    def id(self) -> str:
        """Tells the number, and nothing else."""
        return f"{self.number:03d}"


def case_seed(seed: str, number: int) -> int:
    """The seed of a case: the first 48 bits of the SHA-256 of `SEED/NUMBER`."""
    digest = hashlib.sha256(f"{seed}/{number}".encode()).digest()
    return int.from_bytes(digest[: _BITS // 8])


def draw_lot(
    seed: str,
    number: int,
    kinds: tuple[str, ...] = KINDS,
    engines: tuple[Engine, ...] = ENGINES,
) -> Lot:
    """The lot of case 1, 2, ..., among the kinds and with the engines given."""
    entries = [(kind, n) for kind in BLOCK if kind in kinds for n in range(BLOCK[kind])]
    block, place = divmod(number - 1, len(entries))
    kind, n = entries[int(_stream(seed, "order", block).permutation(len(entries))[place])]
    # Which of its kind the case is in the whole trial: halves, thirds and names take turns by it.
    turn = block * BLOCK[kind] + n
    own = case_seed(seed, number)
    engine: Engine = _in_turn(seed, engines, turn, "engine", kind)
    target = None
    if kind == "single":
        low, high = list(STRENGTHS.values())[turn % len(STRENGTHS)]
        target = float(np.exp(stream(own, "target").uniform(np.log(low), np.log(high))))
    names = {"single": SINGLES, "outside": STRANGE}.get(kind)
    if names:
        kind = f"{kind}:{_in_turn(seed, names, turn)}"
    # The laboratory changes values of the nominal robot: the others stay true.
    spread = 0.0 if kind == "parameters" else float(turn % 2)
    return Lot(number, kind, target, spread, own, engine)


def read_kinds(text: str) -> tuple[str, ...]:
    """`null, single` as names of kinds. Raises InputError for one that there is not."""
    kinds = tuple(part.strip() for part in text.split(",") if part.strip())
    wrong = [kind for kind in kinds if kind not in BLOCK]
    if wrong or not kinds:
        raise InputError(
            f"--kinds: Read {text!r}. Expected some of {', '.join(BLOCK)}, with commas between "
            "them. Correct it, or leave --kinds out for all."
        )
    return tuple(kind for kind in BLOCK if kind in kinds)


def _in_turn(seed: str, names: tuple[_Name, ...], turn: int, *purpose: object) -> _Name:
    """Every name once, in an order by lot, before any comes again."""
    again, place = divmod(turn, len(names))
    order = _stream(seed, "names", *purpose, len(names), again).permutation(len(names))
    return names[int(order[place])]


def _stream(seed: str, *purpose: object) -> np.random.Generator:
    return stream(case_seed(seed, 0), *purpose)
