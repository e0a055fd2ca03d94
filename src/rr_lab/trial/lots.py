"""What each case of a trial is, drawn from the trial's seed; the case made and sealed.

The seed of a published trial is the hash of the commit that it runs on. Nobody can choose it, as it
changes with every change of the code that is tried.

Kinds come in blocks of fixed composition, shuffled, so that a case depends on nothing but seed,
kinds and its own number: a trial can be extended, and one case can be made again by itself.
"""

from __future__ import annotations

import hashlib
import json
import secrets
import subprocess
import time
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, TypeVar

import numpy as np

from rr_lab.case import Case, Delivery, stream
from rr_lab.disturbances import DISTURBANCES, disturbance_named
from rr_lab.effects import OUTSIDE_NAMES, REALISATIONS, effect_named
from rr_lab.engines import ENGINES, Engine
from rr_lab.files import answer, folder_of, seal_of
from rr_lab.random_case import KINDS, SINGLES, random_case, read_kind
from rr_lab.trial.refitted import Refit
from rr_opt.outcome import InputError, NotConvergedError

_HINT = "Commit the changes, or give a seed of your own with --seed."


def seed_of_commit(source: Path, results: Path) -> str:
    """The hash of the commit that the code in `source` is at, 40 hexadecimal digits.

    results: a folder in which changes are none of the code. Raises InputError if there is no
    commit, or files differ from it.
    """
    try:
        commit = _git(source, "rev-parse", "HEAD").strip()
        top = Path(_git(source, "rev-parse", "--show-toplevel").strip())
        own = []
        if results.resolve().is_relative_to(top):
            own = [f":(exclude,top){results.resolve().relative_to(top)}"]
        changed = _git(top, "status", "--porcelain", "--", ".", *own).splitlines()
    except (OSError, subprocess.CalledProcessError):
        raise InputError(
            f"The code in {source} is in no git repository. Expected a commit, whose hash is the "
            "seed. Give a seed of your own with --seed."
        ) from None
    if changed:
        more = f" and {len(changed) - 1} more" if len(changed) > 1 else ""
        raise InputError(
            f"Read changes that are in no commit: {changed[0].strip()}{more}. Expected the code as "
            f"it was committed, since the commit's hash is the seed. {_HINT}"
        )
    return commit


def read_seed(text: str) -> str:
    """A seed of the user's own, hexadecimal digits. Raises InputError for anything else."""
    word = text.strip().lower().removeprefix("0x")
    if not word or set(word) - set("0123456789abcdef"):
        raise InputError(
            f"--seed: Read {text!r}. Expected hexadecimal digits such as 1f3a, or `commit` for the "
            "hash of the commit. Correct it."
        )
    return word


def fingerprint(source: Path) -> str:
    """SHA-256 over the names and contents of all files of a package, as C and YAML decide what is
    computed too. What Python compiled from them is left out."""
    sums = hashlib.sha256()
    paths = (path for path in source.rglob("*") if path.is_file())
    for path in sorted(path for path in paths if "__pycache__" not in path.parts):
        digest = hashlib.sha256(path.read_bytes()).hexdigest()
        sums.update(f"{path.relative_to(source).as_posix()} {digest}\n".encode())
    return sums.hexdigest()


def _git(folder: Path, *words: str) -> str:
    return subprocess.run(
        ["git", "-C", str(folder), *words], capture_output=True, text=True, check=True
    ).stdout


BLOCK = {"null": 5, "single": 9, "pair": 2, "parameters": 2, "outside": 2, "disturbed": 5}
"""How many of each kind there are in a block: twenty, and five disturbed ones if asked for."""

STRENGTHS = {"faint": (2.0, 5.0), "medium": (5.0, 15.0), "strong": (15.0, 60.0)}
"""RMS deviation from the nominal robot's run, sigma of the noise; drawn evenly in its logarithm."""

TORQUE = 0.3
"""The share of cases whose recordings have the servo's torque."""

_BITS = 48
_Any = TypeVar("_Any")


@dataclass(frozen=True)
class Lot:
    """What a case is made from.

    kind    as `random_case` takes it: null, parameters, pair, single:EFFECT/REALISATION, ...
    target  visibility of a single effect, sigma; None: drawn by the laboratory
    spread  0: the nominal values are true; 1: they are off by chance, as their uncertainties say
    seed    the case's own
    engine  what drives it
    disturbance  of its recordings, by name
    """

    number: int
    kind: str
    target: float | None
    spread: float
    seed: int
    engine: Engine = "mujoco"
    disturbance: str = ""

    @property
    def id(self) -> str:
        """Tells the number, and nothing else."""
        return f"{self.number:03d}"


def case_seed(seed: str, number: int) -> int:
    """The seed of a case: the first 48 bits of the SHA-256 of `SEED/NUMBER`."""
    digest = hashlib.sha256(f"{seed}/{number}".encode()).digest()
    return int.from_bytes(digest[: _BITS // 8])


def draw_lot(
    seed: str, number: int, kinds: tuple[str, ...] = KINDS, engines: tuple[Engine, ...] = ENGINES
) -> Lot:
    """The lot of case 1, 2, ..., among the kinds and with the engines given."""
    entries = [kind for kind in _ordered(kinds) for _ in range(BLOCK[kind.partition(":")[0]])]
    block, place = divmod(number - 1, len(entries))
    order = [entries[k] for k in _stream(seed, "order", block).permutation(len(entries))]
    kind = order[place]
    # How many of its kind came before: engines, strengths and names take turns by it.
    turn = block * entries.count(kind) + order[:place].count(kind)
    own = case_seed(seed, number)
    engine: Engine = _alternately(seed, engines, turn, "engine", kind)
    target, disturbance = None, ""
    head, _, named = kind.partition(":")
    if head == "disturbed":
        disturbance = named or _in_turn(seed, tuple(DISTURBANCES), turn)
        again = turn if named else turn // len(DISTURBANCES)
        head, named = _alternately(seed, ("single", "null"), again, disturbance), ""
        kind = head
    if head == "single":
        low, high = list(STRENGTHS.values())[turn % len(STRENGTHS)]
        target = float(np.exp(stream(own, "target").uniform(np.log(low), np.log(high))))
    names = {"single": SINGLES, "outside": OUTSIDE_NAMES}.get(head)
    if names and not named:
        again, named = turn // len(names), _in_turn(seed, names, turn)
        kind = f"{head}:{_alternately(seed, REALISATIONS[named], again, named).key}"
    # The laboratory changes values of the nominal robot: the others stay true. Two cases in a row
    # are alike in this, so that both engines have as many of either.
    spread = 0.0 if head == "parameters" else float(turn // 2 % 2)
    return Lot(number, kind, target, spread, own, engine, disturbance)


def read_kinds(text: str) -> tuple[str, ...]:
    """`null, single` as names of kinds; `single:EFFECT`, `pair:EFFECT+EFFECT`, `outside:EFFECT` and
    `disturbed:DISTURBANCE` are kinds of their own. Raises InputError for one that there is not."""
    kinds = tuple(part.strip() for part in text.split(",") if part.strip())
    wrong = [kind for kind in kinds if kind.partition(":")[0] not in BLOCK]
    if wrong or not kinds:
        raise InputError(
            f"--kinds: Read {text!r}. Expected some of {', '.join(BLOCK)}, with commas between "
            "them. Correct it, or leave --kinds out for all."
        )
    for kind in kinds:
        head, _, name = kind.partition(":")
        if head == "disturbed":
            disturbance_named(name)
        else:
            read_kind(kind)
    return _ordered(kinds)


def _ordered(kinds: tuple[str, ...]) -> tuple[str, ...]:
    """Each once, so that the order in which they are given changes nothing."""
    order = list(BLOCK)
    return tuple(sorted(set(kinds), key=lambda kind: (order.index(kind.partition(":")[0]), kind)))


def _in_turn(seed: str, names: tuple[str, ...], turn: int) -> str:
    """Every name once, in a random order, before any comes again."""
    again, place = divmod(turn, len(names))
    order = _stream(seed, "names", len(names), again).permutation(len(names))
    return names[int(order[place])]


def _alternately(seed: str, several: tuple[_Any, ...], turn: int, *purpose: object) -> _Any:
    """One after the other, from a random one on."""
    first = int(_stream(seed, *purpose).integers(len(several)))
    return several[(first + turn) % len(several)]


def _stream(seed: str, *purpose: object) -> np.random.Generator:
    return stream(case_seed(seed, 0), *purpose)


@dataclass(frozen=True)
class Made:
    """files by name; answer, a JSON text with a random word in it; seal, its SHA-256; seconds of
    CPU. Where the laboratory failed, why, and nothing else."""

    files: Mapping[str, bytes]
    answer: str
    seal: str
    seconds: float
    failed: str = ""


def make(lot: Lot, seconds: float = 30.0) -> Made:
    """Draw, drive and record a case; seconds: length of each run.

    If the engine fails, `failed` says why; nothing is raised.
    """
    began = time.process_time()
    try:
        case = random_case(
            lot.seed,
            lot.kind,
            target=lot.target,
            spread=lot.spread,
            seconds=seconds,
            engine=lot.engine,
            disturbance=lot.disturbance,
        )
        text = _answer_text(case, lot)
        with_torque = stream(lot.seed, "torque").random() < TORQUE
        files = dict(folder_of(case, Delivery(torque=bool(with_torque))))
    except NotConvergedError as error:
        return Made({}, "", "", time.process_time() - began, str(error))
    return Made(files, text, seal_of(text), time.process_time() - began)


def _answer_text(case: Case, lot: Lot) -> str:
    """The laboratory's answer, what was drawn, and how visible each effect remains."""
    data: dict[str, Any] = {
        "number": lot.number,
        "kind": "disturbed" if lot.disturbance else lot.kind.partition(":")[0],
        "hidden": [effect_named(use.name).name for use in case.effects],
        "spread": lot.spread,
        **answer(case),
        "stays_visible": _stays_visible(case),
        # So that the seal of a guess never matches.
        "salt": secrets.token_hex(16),
    }
    return json.dumps(data, indent=2) + "\n"


def _stays_visible(case: Case) -> dict[str, float]:
    """RMS in sigma that each effect alone leaves after the parameters are re-fitted."""
    if not case.effects:
        return {}
    case = replace(case, disturbance="")
    refit, nominal = Refit.of(case), replace(case, robot=case.nominal)
    return {
        effect_named(use.name).name: float(f"{refit.left(replace(nominal, effects=(use,))):.4g}")
        for use in case.effects
    }
