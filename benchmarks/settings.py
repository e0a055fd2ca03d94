"""How the diagnosis depends on each number that was chosen: halved and doubled, on fixed cases.

    python -m benchmarks.settings --cases 40 --workers 2

Every variant of `rr_opt.sysid.settings` diagnoses the same cases of the laboratory, blind as in
`rr-opt prove`. Finished diagnoses are kept in --out; the same command resumes. The table goes to
results/settings/README.md. A number that moves nothing either way can go.
"""

from __future__ import annotations

import argparse
import json
import sys
from collections import Counter
from collections.abc import Mapping, Sequence
from contextlib import closing
from dataclasses import fields
from functools import partial
from pathlib import Path
from typing import Any

from rr_lab.case import ENGINES
from rr_lab.trial import Trial
from rr_lab.trial.draws import KINDS, Basis, fingerprint, read_seed
from rr_lab.trial.isolation import opened_case
from rr_lab.trial.outcome import Case
from rr_opt.batch.journal import Journal
from rr_opt.batch.run import pool_of, run
from rr_opt.documents.archive import write_text
from rr_opt.sysid.settings import SETTINGS

RESULTS = Path(__file__).parents[1] / "results" / "settings"
AS_CHOSEN = "as chosen"


def varied(value: Any, factor: float) -> Any:
    """A setting times a factor: a count stays one, a share near 1 has its odds multiplied."""
    if isinstance(value, tuple):
        return tuple(varied(one, factor) for one in value)
    if isinstance(value, int):
        return max(round(value * factor), 1)
    if 0.5 <= value < 1:
        odds = factor * value / (1 - value)
        return odds / (1 + odds)
    return value * factor


def variants(only: Sequence[str]) -> dict[str, dict[str, Any]]:
    """What is changed, by the variant's name."""
    out: dict[str, dict[str, Any]] = {AS_CHOSEN: {}}
    for field in fields(SETTINGS):
        value = getattr(SETTINGS, field.name)
        for word, factor in (("halved", 0.5), ("doubled", 2.0)):
            changed = varied(value, factor)
            if changed != value and (not only or field.name in only):
                out[f"{field.name} {word}"] = {field.name: changed}
    return out


def command(changes: Mapping[str, Any]) -> tuple[str, ...]:
    """`rr-opt diagnose` with other settings."""
    code = (
        "from dataclasses import replace; from rr_opt.sysid import settings as s; "
        f"s.SETTINGS = replace(s.SETTINGS, **{dict(changes)!r}); "
        "from rr_opt.cli.entry import main; main()"
    )
    return (sys.executable, "-I", "-u", "-c", code, "diagnose", "--no-page")


def table(cases: Mapping[str, Sequence[Case]]) -> str:
    """Right answers of each kind, and false names, by variant."""
    kinds = sorted({case.truth.kind for case in cases[AS_CHOSEN]})
    before = {case.id: case.outcome for case in cases[AS_CHOSEN]}
    head = ["setting", *kinds, "false names", "CPU, s", "cases that differ"]
    lines = ["| " + " | ".join(head) + " |", "|---" * len(head) + "|"]
    for name, every in cases.items():
        total = Counter(case.truth.kind for case in every)
        right = Counter(case.truth.kind for case in every if case.outcome == "right")
        wrong = sum(bool(case.extra) for case in every if case.truth.kind != "outside")
        cpu = sorted(case.cpu for case in every)[len(every) // 2]
        other = [case.id for case in every if case.outcome != before[case.id]]
        counts = [f"{right[kind]} of {total[kind]}" for kind in kinds]
        row = [name, *counts, str(wrong), f"{cpu:.0f}", ", ".join(other)]
        lines.append("| " + " | ".join(row) + " |")
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
    given = parser.parse_args()
    basis = Basis(read_seed(given.seed), tuple(given.kinds.split(",")), ENGINES)
    trial = Trial(given.out, [basis.draw(number) for number in range(1, given.cases + 1)])
    identity = {"seed": basis.seed, "kinds": list(basis.kinds)}
    ids = {draw.number: draw.id for draw in trial.draws}
    found: dict[str, Sequence[Case]] = {}
    with closing(pool_of(given.workers, None)) as pool:
        with Journal(given.out / "made.jsonl", identity) as made:
            for number in trial.make(made, partial(run, pool)):
                print(f"made case {number}", flush=True)
        own = {number: row for number, row in made.rows.items() if number in ids}
        for name, changes in variants([one for one in given.only.split(",") if one]).items():
            of = {**identity, "code": fingerprint(), "changes": json.loads(json.dumps(changes))}
            place = given.out / f"{name.replace(' ', '-')}.jsonl"
            with Journal(place, of) as said:
                for number in trial.diagnose(own, said, partial(run, pool), command(changes)):
                    print(f"{name}: case {number}", flush=True)
            found[name] = [
                opened_case(ids[k], _answer(given.out, ids[k]), row)
                for k, row in said.rows.items()
                if k in ids
            ]
            text = f"# Each chosen number halved and doubled\n\n{len(own)} cases, seed {basis.seed}"
            write_text(RESULTS / "README.md", f"{text}.\n\n{table(found)}")


def _answer(folder: Path, id: str) -> dict[str, Any]:
    return json.loads((folder / "answers" / f"{id}.json").read_text(encoding="utf-8"))


if __name__ == "__main__":
    main()
