"""How the diagnosis depends on each number that was chosen: halved and doubled, on fixed cases.

    python -m benchmarks.settings --cases 40 --workers 2
    python -m benchmarks.settings --cases 80 --only named,further --page judging.md

Every variant of `rr_opt.sysid.settings` diagnoses the same cases of the laboratory, without the
page. A case's variants share a process; what a number does not enter, such as a fit that a
threshold only judges, is computed once. Finished cases are kept in --out; the same command resumes.
The table goes to results/settings. A number that moves nothing either way can go.
"""

from __future__ import annotations

import argparse
import json
import time
from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import closing, contextmanager
from dataclasses import dataclass, field, fields
from functools import partial
from pathlib import Path
from typing import Any
from unittest.mock import patch

import numpy as np

from rr_lab.case import ENGINES
from rr_lab.trial import Trial
from rr_lab.trial.draws import KINDS, Basis, fingerprint, read_seed
from rr_lab.trial.outcome import Case, Claim, Named, Truth
from rr_opt.batch.journal import Journal
from rr_opt.batch.run import pool_of, run
from rr_opt.documents.archive import write_text
from rr_opt.machines.racer.racer import RollerRacer
from rr_opt.recordings.clock_fit import at_commanded_rate
from rr_opt.recordings.experiment import read_experiment, usable
from rr_opt.sysid import diagnose, estimation, selection
from rr_opt.sysid.model import ChannelNoise, Choice, Segment
from rr_opt.sysid.settings import SETTINGS, Settings
from rr_opt.sysid.verdict import alike, findings, verdict_of, wrong_values

RESULTS = Path(__file__).parents[1] / "results" / "settings"
AS_CHOSEN = "as chosen"
OTHER_MACHINES = ("growth", "input_share", "input_noise", "modes", "windows")
"""Enter no diagnosis of a Roller Racer."""

COMPUTED = (
    (estimation, ("whole_runs",)),
    (selection, ("first", "fitted", "polished", "predicted", "scores")),
    (diagnose, ("dependences", "evaluation", "first", "noise_in", "refitted", "settled")),
    (RollerRacer, ("proposals", "unknown_inputs", "upstream", "with_noise")),
)
"""Where the time goes."""


class Watched(Settings):
    """Settings that tell which of them were read."""

    read: set[str] | None = None

    def __getattribute__(self, name: str) -> Any:
        """The value, noted while `read` is a set."""
        if Watched.read is not None:
            Watched.read.add(name)
        return super().__getattribute__(name)


@dataclass
class Memory:
    """What functions returned, by their arguments, and the settings that were read in them."""

    kept: dict[Any, Any] = field(default_factory=dict)
    alive: list[Any] = field(default_factory=list)
    read: set[str] = field(default_factory=set)

    def remembering(self, function: Callable[..., Any]) -> Callable[..., Any]:
        """The function, computed once for the same arguments."""

        def once(*given: Any, **named: Any) -> Any:
            key = (function.__qualname__, self._key(given), self._key(named))
            if key not in self.kept:
                with self.watching():
                    self.kept[key] = function(*given, **named)
            return self.kept[key]

        return once

    @contextmanager
    def watching(self) -> Iterator[None]:
        """Note the settings that are read."""
        outer, Watched.read = Watched.read, self.read
        try:
            yield
        finally:
            Watched.read = outer

    def _key(self, given: Any) -> Any:
        """Values by what they are, everything else by which object it is."""
        if given is None or isinstance(given, str | float | Choice | ChannelNoise | Segment):
            return given
        if isinstance(given, int | range):
            return given
        if isinstance(given, np.ndarray):
            return given.shape, given.tobytes()
        if isinstance(given, Mapping) and all(isinstance(k, str | int) for k in given):
            return tuple((self._key(k), self._key(v)) for k, v in sorted(given.items()))
        if isinstance(given, Sequence):
            return tuple(map(self._key, given))
        self.alive.append(given)
        return id(given)

    @contextmanager
    def used(self) -> Iterator[None]:
        """Remember in what the diagnosis calls."""
        patches = [
            patch.object(place, name, self.remembering(getattr(place, name)))
            for place, names in COMPUTED
            for name in names
        ]
        for one in patches:
            one.start()
        try:
            yield
        finally:
            for one in patches:
                one.stop()


@contextmanager
def changed(changes: Mapping[str, Any]) -> Iterator[None]:
    """Other settings, for a while."""
    before = {name: getattr(SETTINGS, name) for name in changes}
    for name, value in changes.items():
        object.__setattr__(SETTINGS, name, value)
    try:
        yield
    finally:
        for name, value in before.items():
            object.__setattr__(SETTINGS, name, value)


def varied(value: float, factor: float) -> float:
    """A setting times a factor: a count stays one, a share near 1 has its odds multiplied."""
    if isinstance(value, int):
        return max(round(value * factor), 1)
    if 0.5 <= value < 1:
        odds = factor * value / (1 - value)
        return odds / (1 + odds)
    return value * factor


def variants(only: Sequence[str]) -> dict[str, dict[str, Any]]:
    """What is changed, by the variant's name."""
    out: dict[str, dict[str, Any]] = {AS_CHOSEN: {}}
    for one in fields(Settings):
        value = getattr(SETTINGS, one.name)
        for word, factor in (("halved", 0.5), ("doubled", 2.0)):
            other = varied(value, factor)
            wanted = one.name in only if only else one.name not in OTHER_MACHINES
            if other != value and wanted:
                out[f"{one.name} {word}"] = {one.name: other}
    return out


def said(model: RollerRacer) -> dict[str, Any]:
    """The diagnosis, as far as it is scored."""
    began = time.process_time()
    result = diagnose.identified(model, diagnose.Stopwatch())
    verdict, named = verdict_of(result), ()
    if verdict in ("missing_physics", "parameters"):
        named = (findings if verdict == "missing_physics" else wrong_values)(result)
    return {
        "verdict": verdict,
        "named": {one.name: one.confidence for one in named},
        "groups": alike(result) if verdict == "missing_physics" else (),
        "cpu": round(time.process_time() - began, 2),
    }


def every_variant(folder: Path, wanted: Mapping[str, Mapping[str, Any]]) -> dict[str, Any]:
    """What each variant says of a case."""
    object.__setattr__(SETTINGS, "__class__", Watched)
    experiment, _ = usable(read_experiment(folder))
    model = RollerRacer(at_commanded_rate(experiment))
    as_chosen, out = Memory(), {}
    with as_chosen.watching():
        _ = model.runs, model.form_error, model.catalogue
    for name, changes in wanted.items():
        with changed(changes):
            if not changes.keys() & as_chosen.read:
                with as_chosen.used():
                    out[name] = said(model)
            # It may have been read only now.
            if changes.keys() & as_chosen.read:
                out[name] = said(RollerRacer(model.experiment))
    return out


def case_of(id: str, answer: Mapping[str, Any], said: Mapping[str, Any]) -> Case:
    """A case and what was said of it."""
    named = tuple(Named(name, confidence, {}) for name, confidence in said["named"].items())
    claim = Claim(said["verdict"], named, tuple(map(frozenset, said["groups"])))
    return Case(id, Truth.of(answer), claim, cpu=said["cpu"])


def table(cases: Mapping[str, Sequence[Case]]) -> str:
    """Right answers of each kind, and false names, by variant."""
    kinds = sorted({case.truth.kind for case in cases[AS_CHOSEN]})
    before = {case.id: case.outcome for case in cases[AS_CHOSEN]}
    head = ["setting", *kinds, "false names", "other outcomes"]
    lines = ["| " + " | ".join(head) + " |", "|---" * len(head) + "|"]
    for name, every in cases.items():
        total = Counter(case.truth.kind for case in every)
        right = Counter(case.truth.kind for case in every if case.outcome == "right")
        wrong = sum(bool(case.extra) for case in every if case.truth.kind != "outside")
        other = [
            f"{case.id}: {before[case.id]} -> {case.outcome}"
            for case in every
            if case.outcome != before[case.id]
        ]
        counts = [f"{right[kind]} of {total[kind]}" for kind in kinds]
        lines.append("| " + " | ".join([name, *counts, str(wrong), "; ".join(other)]) + " |")
    return "\n".join(lines) + "\n"


def main() -> None:
    """Make the cases, diagnose them with every variant, write the table."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").split("\n")[0])
    parser.add_argument("--cases", type=int, default=40)
    parser.add_argument("--seed", default="5e771465")
    parser.add_argument("--workers", type=int)
    parser.add_argument("--only", default="", help="settings, separated by commas")
    parser.add_argument("--kinds", default=",".join(KINDS))
    parser.add_argument("--out", type=Path, default=Path("out/settings"))
    parser.add_argument("--page", default="README.md")
    given = parser.parse_args()
    basis = Basis(read_seed(given.seed), tuple(given.kinds.split(",")), ENGINES)
    trial = Trial(given.out, [basis.draw(number) for number in range(1, given.cases + 1)])
    identity = {"seed": basis.seed, "kinds": list(basis.kinds)}
    ids = {draw.number: draw.id for draw in trial.draws}
    wanted = variants([one for one in given.only.split(",") if one])
    with closing(pool_of(given.workers, None)) as pool:
        with Journal(given.out / "made.jsonl", identity) as made:
            for number in trial.make(made, partial(run, pool)):
                print(f"made case {number}", flush=True)
        of = {**identity, "code": fingerprint(), "variants": json.loads(json.dumps(wanted))}
        with Journal(given.out / "said.jsonl", of) as answers:
            left = {
                number: (given.out / "cases" / id)
                for number, id in ids.items()
                if number not in answers.rows
            }
            for number, every in run(pool, partial(every_variant, wanted=wanted), left):
                if isinstance(every, str):
                    raise SystemExit(f"case {ids[number]}: {every}")
                answers.append(number, every)
                print(f"case {ids[number]}", flush=True)
                rows = {ids[k]: row for k, row in answers.rows.items()}
                write_text(RESULTS / given.page, page(given.out, basis.seed, rows))


def page(folder: Path, seed: str, rows: Mapping[str, Mapping[str, Any]]) -> str:
    """The table of the cases that are finished."""
    cases = {
        name: [case_of(id, _answer(folder, id), row[name]) for id, row in rows.items()]
        for name in next(iter(rows.values()))
    }
    text = f"# Each chosen number halved and doubled\n\n{len(rows)} cases, seed {seed}."
    return f"{text}\n\n{table(cases)}"


def _answer(folder: Path, id: str) -> dict[str, Any]:
    return json.loads((folder / "answers" / f"{id}.json").read_text(encoding="utf-8"))


if __name__ == "__main__":
    main()
