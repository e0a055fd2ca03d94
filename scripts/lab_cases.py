"""Make cases by lot: `python scripts/lab_cases.py OUT --kind single --count 8 --seed 1`.

Each is a folder that `rr-opt diagnose` reads, OUT/case-SEED, with its answer beside it,
OUT/case-SEED.answer.json. `--kind catalogue` goes through all effects that have a name, one a case.
"""

from __future__ import annotations

import argparse
import sys
import time
from pathlib import Path

from rr_lab.engines import ENGINES
from rr_lab.files import answer, folder_of
from rr_lab.random_case import NAMED, random_case
from rr_opt.report.archive import write_bytes, write_json


def main() -> None:
    parser = argparse.ArgumentParser(description="Make cases by lot.")
    parser.add_argument("out", type=Path)
    parser.add_argument(
        "--kind", default="random", help="null, parameters, single[:EFFECT], pair, "
        "outside[:EFFECT], random (default) or catalogue"
    )  # fmt: skip
    parser.add_argument("--count", type=int, default=1)
    parser.add_argument("--seed", type=int, default=0, help="of the first case; then one more each")
    parser.add_argument("--seconds", type=float, default=30.0)
    parser.add_argument("--visibility", type=float, help="of each effect, sigma; drawn if left out")
    parser.add_argument("--engine", choices=ENGINES, default="mujoco")
    parser.add_argument("--spread", type=float, default=0.0, help="0: nominal values are exact")
    asked = parser.parse_args()
    for n in range(asked.count):
        kind = f"single:{NAMED[n % len(NAMED)]}" if asked.kind == "catalogue" else asked.kind
        began = time.perf_counter()
        case = random_case(
            asked.seed + n,
            kind,
            seconds=asked.seconds,
            target=asked.visibility,
            spread=asked.spread,
            engine=asked.engine,
        )
        folder = asked.out / case.name
        for name, content in folder_of(case):
            write_bytes(folder / name, content)
        write_json(asked.out / f"{case.name}.answer.json", answer(case))
        print(f"{folder}  {kind}  {time.perf_counter() - began:.0f} s", file=sys.stderr)


if __name__ == "__main__":
    main()
