"""The cases of a trial, drawn from its seed and their numbers; each driven, recorded and sealed.

The seed of a published trial is the hash of the commit that it runs on. Nobody can choose it, as it
changes with every change of the code under test.

Cases come in pairs of one kind, one driven by each engine, and kinds in blocks of fixed
composition, shuffled. A case depends only on seed, kinds and its own number: a trial can be
extended, and a single case can be remade.
"""

import hashlib
import json
import secrets
import subprocess
import time
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from rr_lab.case import ENGINES, Case, Engine, stream
from rr_lab.disturbances import DISTURBANCES, disturbance_named
from rr_lab.effect_size import Detectability
from rr_lab.effects import OUTSIDE_NAMES, REALISATIONS, effect_named
from rr_lab.files import Delivery, answer, folder_of, seal_of
from rr_lab.random_case import SINGLES, random_case, read_kind
from rr_opt.outcome import InputError, NotConvergedError

BLOCK = {"null": 3, "single": 7, "pair": 2, "parameters": 2, "outside": 3, "disturbed": 3}
"""Pairs of cases of each kind in a block of forty cases."""

KINDS = tuple(BLOCK)

STRENGTHS = {"faint": (2.0, 5.0), "medium": (5.0, 15.0), "strong": (15.0, 60.0)}
"""Effect sizes, sigma; drawn uniformly in their logarithm."""

CODE = tuple(Path(__file__).parents[2] / package for package in ("rr_opt", "rr_lab"))
"""The code under test, and the code that tests it."""

_BITS = 48


@dataclass(frozen=True)
class Draw:
    """The specification of a case.

    kind    as `random_case` takes it: null, parameters, pair, single:EFFECT/REALISATION, ...
    target  effect size of a single effect, sigma; None: drawn by the laboratory
    spread  0: the nominal values are true; 1: they are drawn within their uncertainties
    seed    the case's own
    engine  the physics engine
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
        """Reveals the number, and nothing else."""
        return f"{self.number:03d}"


@dataclass(frozen=True)
class Basis:
    """The settings that the cases of a trial are drawn from."""

    seed: str
    kinds: tuple[str, ...] = KINDS
    engines: tuple[Engine, ...] = ENGINES

    def draw(self, number: int) -> Draw:
        """Case 1, 2, ..."""
        entries = [kind for kind in _ordered(self.kinds) for _ in range(BLOCK[_head(kind)])]
        pair, second = divmod(number - 1, 2)
        block, place = divmod(pair, len(entries))
        order = [entries[k] for k in _stream(self.seed, "order", block).permutation(len(entries))]
        kind = order[place]
        # How many cases of the kind came before: determines item, engine and strength in turn.
        turn = 2 * (block * entries.count(kind) + order[:place].count(kind)) + second
        items = _items(kind)
        cycle, at = divmod(turn, len(items))
        # Two cycles in a row have one order, so that the second gives each item the other engine.
        rng = _stream(self.seed, "items", kind, cycle // 2)
        item, disturbance = items[int(rng.permutation(len(items))[at])]
        first = int(rng.integers(len(self.engines)))
        engine = self.engines[(first + at + cycle) % len(self.engines)]
        own, target = case_seed(self.seed, number), None
        if item.startswith("single"):
            low, high = list(STRENGTHS.values())[turn % len(STRENGTHS)]
            target = float(np.exp(stream(own, "target").uniform(np.log(low), np.log(high))))
        # The laboratory changes values of the nominal robot: the others remain true.
        spread = 0.0 if item == "parameters" else float(turn // 2 % 2)
        return Draw(number, item, target, spread, own, engine, disturbance)


def case_seed(seed: str, number: int) -> int:
    """The seed of a case: the first 48 bits of the SHA-256 of `SEED/NUMBER`."""
    digest = hashlib.sha256(f"{seed}/{number}".encode()).digest()
    return int.from_bytes(digest[: _BITS // 8])


def _stream(seed: str, *purpose: object) -> np.random.Generator:
    return stream(case_seed(seed, 0), *purpose)


def _items(kind: str) -> tuple[tuple[str, str], ...]:
    """All items of a kind: kind of case and disturbance."""
    head, _, name = kind.partition(":")
    if head == "disturbed":
        names = (name,) if name else tuple(DISTURBANCES)
        return tuple((hidden, each) for each in names for hidden in ("single", "null"))
    if head not in ("single", "outside"):
        return ((kind, ""),)
    names = (name,) if name else SINGLES if head == "single" else OUTSIDE_NAMES
    effects = [each for one in names for each in REALISATIONS.get(one, (effect_named(one),))]
    return tuple((f"{head}:{each.key}", "") for each in effects)


def _head(kind: str) -> str:
    return kind.partition(":")[0]


def _ordered(kinds: tuple[str, ...]) -> tuple[str, ...]:
    """Each once, so that the given order does not matter."""
    return tuple(sorted(set(kinds), key=lambda kind: (KINDS.index(_head(kind)), kind)))


def read_kinds(text: str) -> tuple[str, ...]:
    """Names of kinds from `null, single`; `single:EFFECT`, `pair:EFFECT+EFFECT`, `outside:EFFECT`
    and `disturbed:DISTURBANCE` are kinds of their own. Raises InputError for an unknown one."""
    kinds = tuple(part.strip() for part in text.split(",") if part.strip())
    if not kinds or any(_head(kind) not in BLOCK for kind in kinds):
        raise InputError(
            f"--kinds: Read {text!r}. Expected one or more of {', '.join(BLOCK)}, separated by "
            "commas. Correct it, or leave out --kinds for all of them."
        )
    for kind in kinds:
        head, _, name = kind.partition(":")
        if head == "disturbed":
            disturbance_named(name)
        else:
            read_kind(kind)
    return _ordered(kinds)


def read_seed(text: str) -> str:
    """A user-defined seed, hexadecimal digits. Raises InputError for anything else."""
    word = text.strip().lower().removeprefix("0x")
    if not word or set(word) - set("0123456789abcdef"):
        raise InputError(
            f"--seed: Read {text!r}. Expected hexadecimal digits such as 1f3a, or `commit` for the "
            "commit's hash. Correct it."
        )
    return word


def seed_of_commit(source: Path, results: Path) -> str:
    """The hash of the commit of the code in `source`, 40 hexadecimal digits.

    results: a folder whose changes are ignored. Raises InputError if there is no commit, or files
    differ from it.
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
            f"The code in {source} is not in a git repository. Expected a commit, whose hash is "
            "the seed. Give your own seed with --seed."
        ) from None
    if changed:
        more = f" and {len(changed) - 1} more" if len(changed) > 1 else ""
        raise InputError(
            f"Read uncommitted changes: {changed[0].strip()}{more}. Expected none, since the "
            "commit's hash is the seed. Commit the changes, or give your own seed with --seed."
        )
    return commit


def fingerprint(*sources: Path) -> str:
    """SHA-256 over the names and contents of all files of packages, by default of the diagnosis and
    the laboratory, including C and YAML, excluding compiled Python."""
    sums = hashlib.sha256()
    for source in sources or CODE:
        paths = (path for path in source.rglob("*") if path.is_file())
        for path in sorted(path for path in paths if "__pycache__" not in path.parts):
            digest = hashlib.sha256(path.read_bytes()).hexdigest()
            sums.update(f"{path.relative_to(source.parent).as_posix()} {digest}\n".encode())
    return sums.hexdigest()


def _git(folder: Path, *words: str) -> str:
    return subprocess.run(
        ["git", "-C", str(folder), *words], capture_output=True, text=True, check=True
    ).stdout


TORQUE = 0.3
"""The share of cases with the servo's torque in the recordings."""


@dataclass(frozen=True)
class SealedCase:
    """files by name; answer, a JSON text with a random word in it; seal, its SHA-256; CPU seconds.
    If the laboratory failed, only the reason."""

    files: Mapping[str, bytes]
    answer: str
    seal: str
    seconds: float
    failed: str = ""


def make(draw: Draw, seconds: float = 30.0) -> SealedCase:
    """Drive and record a case; seconds: length of each run.

    If the engine fails, `failed` says why; nothing is raised.
    """
    began = time.process_time()
    try:
        case = random_case(
            draw.seed, draw.kind, target=draw.target, spread=draw.spread, seconds=seconds,
            engine=draw.engine, disturbance=draw.disturbance,
        )  # fmt: skip
        text = _answer_text(case, draw)
        with_torque = stream(draw.seed, "torque").random() < TORQUE
        files = dict(folder_of(case, Delivery(torque=bool(with_torque))))
    except NotConvergedError as error:
        return SealedCase({}, "", "", time.process_time() - began, str(error))
    return SealedCase(files, text, seal_of(text), time.process_time() - began)


def _answer_text(case: Case, draw: Draw) -> str:
    """The laboratory's answer, the drawn settings, and how detectable each effect is."""
    data: dict[str, Any] = {
        "number": draw.number,
        "kind": "disturbed" if draw.disturbance else draw.kind.partition(":")[0],
        "hidden": [effect_named(use.name).name for use in case.effects],
        "spread": draw.spread,
        **answer(case),
        "stays_visible": _remains(case),
        # So that the seal of a guess never matches.
        "salt": secrets.token_hex(16),
    }
    return json.dumps(data, indent=2) + "\n"


def _remains(case: Case) -> dict[str, float]:
    """RMS in sigma that each effect, beside the others, leaves after re-fitting the parameters: a
    robot with much drag, say, may not reach a patch that it would reach without; nor wheels slide
    that would with the nominal values. Errors of these are not counted as the effect's."""
    case = replace(case, nominal=case.robot, disturbance="")
    left = {}
    for use in case.effects:
        others = [one for one in case.effects if one is not use]
        remains = Detectability.of(case, others).remains(case)
        left[effect_named(use.name).name] = float(f"{remains:.4g}")
    return left
