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
from collections import Counter
from collections.abc import Mapping, Sequence
from contextlib import closing
from functools import partial
from pathlib import Path
from typing import Any

from benchmarks.settings.variants import AS_CHOSEN, every_variant, variants
from rr_lab.case import ENGINES
from rr_lab.trial import Trial
from rr_lab.trial.draws import KINDS, Basis, fingerprint, read_seed
from rr_lab.trial.outcome import Case, Claim, Named, Truth
from rr_opt.batch.journal import Journal
from rr_opt.batch.run import pool_of, run
from rr_opt.documents.archive import write_text

RESULTS = Path(__file__).parents[2] / "results" / "settings"


def case_of(id: str, answer: Mapping[str, Any], said: Mapping[str, Any]) -> Case:
    """A case and what was said of it."""
    named = tuple(Named(name, confidence, {}) for name, confidence in said["named"].items())
    claim = Claim(said["verdict"], named, tuple(map(frozenset, said["groups"])))
    return Case(id, Truth.of(answer), claim, cpu=said["cpu"])


def confidences(case: Case) -> dict[str, float]:
    """Of what is named."""
    return {one.name: one.confidence for one in case.claim.named} if case.claim else {}


def table(cases: Mapping[str, Sequence[Case]]) -> str:
    """Right answers of each kind, false names, and by how much confidences move, by variant."""
    kinds = sorted({case.truth.kind for case in cases[AS_CHOSEN]})
    before = {case.id: case.outcome for case in cases[AS_CHOSEN]}
    sure = {case.id: confidences(case) for case in cases[AS_CHOSEN]}
    head = ["setting", *kinds, "false names", "confidence moves", "other outcomes"]
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
        moves = max(
            (
                abs(confidence - sure[case.id][effect])
                for case in every
                for effect, confidence in confidences(case).items()
                if effect in sure[case.id]
            ),
            default=0.0,
        )
        row = [name, *counts, str(wrong), f"{moves:.3f}", "; ".join(other)]
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
