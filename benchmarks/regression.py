"""Is any ratio of a benchmark much worse than the one that is committed?

`python -m benchmarks.regression [REVISION]` compares results/bench/*.json in the working tree with
those of a revision, the last commit unless one is given. A bigger ratio is better. One that is
worse by more than 30 %, or is gone, is shown in red, and the command then ends with 1.
"""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from rich.console import Console
from rich.table import Table

ROOT = Path(__file__).parents[1]
FOLDER = Path("results") / "bench"
WORSE = 0.3
"""By such a share a ratio may be worse."""


@dataclass(frozen=True)
class Change:
    """A ratio as committed and as it is now; None where it is not there."""

    benchmark: str
    label: str
    before: float | None
    now: float | None

    @property
    def worse(self) -> bool:
        """Whether it is so much worse that somebody has to look."""
        if self.before is None:
            return False
        return self.now is None or self.now < (1 - WORSE) * self.before


def changes(root: Path = ROOT, revision: str = "HEAD") -> list[Change]:
    """All ratios of the working tree and of a revision of the repository at `root`."""
    now = {
        path.stem: _ratios(path.read_text(encoding="utf-8"))
        for path in sorted((root / FOLDER).glob("*.json"))
    }
    listed = _git(root, "ls-tree", "--name-only", revision, f"{FOLDER.as_posix()}/")
    names = [Path(name).stem for name in (listed or "").split() if name.endswith(".json")]
    before = {
        name: _ratios(_git(root, "show", f"{revision}:{FOLDER.as_posix()}/{name}.json") or "{}")
        for name in names
    }
    return [
        Change(name, label, before.get(name, {}).get(label), now.get(name, {}).get(label))
        for name in sorted({*before, *now})
        for label in {**before.get(name, {}), **now.get(name, {})}
    ]


def table(found: list[Change]) -> Table:
    """What changed, the worse in red."""
    out = Table(title="Ratios, bigger is better for us")
    out.add_column("benchmark")
    out.add_column("ratio")
    for head in ("committed", "now", "change"):
        out.add_column(head, justify="right")
    for one in found:
        out.add_row(
            one.benchmark,
            one.label,
            _told(one.before),
            _told(one.now),
            _change(one),
            style="red" if one.worse else None,
        )
    return out


def main(arguments: Sequence[str] | None = None) -> None:
    """Show, and end with 1 if any is much worse."""
    parser = argparse.ArgumentParser()
    parser.add_argument("revision", nargs="?", default="HEAD")
    found = changes(ROOT, parser.parse_args(arguments).revision)
    console = Console()
    console.print(table(found))
    worse = [one for one in found if one.worse]
    if worse:
        names = ", ".join(sorted({one.benchmark for one in worse}))
        console.print(
            f"{len(worse)} of {len(found)} ratios are worse by more than {WORSE:.0%} than what is "
            f"committed: {names}. Expected none. Run the benchmark once more on an idle machine; "
            "if it stays, find the change that slowed it down.",
            style="red",
        )
        sys.exit(1)


def _ratios(text: str) -> Mapping[str, float]:
    return json.loads(text).get("ratios", {})


def _git(root: Path, *arguments: str) -> str | None:
    """What git prints, None where it cannot."""
    run = subprocess.run(
        ["git", "-C", str(root), *arguments], capture_output=True, text=True, check=False
    )
    return run.stdout if run.returncode == 0 else None


def _told(ratio: float | None) -> str:
    return "" if ratio is None else f"{ratio:.3g}"


def _change(one: Change) -> str:
    if one.before is None:
        return "new"
    if one.now is None:
        return "gone"
    return f"{100 * (one.now / one.before - 1):+.0f} %"


if __name__ == "__main__":
    main()
