"""What every benchmark writes: results/bench/NAME.md to read, and NAME.json to compare.

The JSON holds `ratios`, of which a bigger one is better for this project, on a line of their own
so that a change is seen in a diff. Where a benchmark has nobody to be held against, a ratio is that
of a fixed piece of work, the yardstick, to its own: another machine changes both.
"""

from __future__ import annotations

import math
import os
import platform
import statistics
import time
from collections.abc import Mapping, Sequence
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Any

import numpy as np

from rr_opt.documents.archive import write_json, write_text

FOLDER = Path(__file__).parents[1] / "results" / "bench"
_PACKAGES = ("numpy", "scipy", "casadi")
_CPUINFO = Path("/proc/cpuinfo")


def machine() -> str:
    """Processor, cores, system and versions, in a line."""
    name = platform.processor()
    if _CPUINFO.exists():
        lines = _CPUINFO.read_text(encoding="utf-8").splitlines()
        told = [line.split(":", 1)[1].strip() for line in lines if line.startswith("model name")]
        name = told[0] if told else name
    found = {one: installed(one) for one in _PACKAGES}
    versions = ", ".join(f"{one} {number}" for one, number in found.items() if number)
    return (
        f"{name or 'unknown processor'} ({platform.machine()}), {os.cpu_count()} cores, "
        f"{platform.system()}, Python {platform.python_version()}, {versions}"
    )


def installed(package: str) -> str | None:
    """The version of a package, None where it is not here."""
    try:
        return version(package)
    except PackageNotFoundError:
        return None


def yardstick() -> float:
    """CPU seconds of a fixed work, some tens of ms: loops in Python, sines, small matrices."""
    seconds = []
    for _ in range(5):
        begun = time.process_time()
        total = 0.0
        for k in range(300_000):
            total += k * 0.5
        wave = np.linspace(0.0, total, 40_000)
        for _ in range(40):
            wave = np.sin(wave)
        turned = np.eye(12)
        for _ in range(3000):
            turned = turned @ np.eye(12)
        seconds.append(time.process_time() - begun)
    return statistics.median(seconds)


def write(name: str, lines: Sequence[str], ratios: Mapping[str, float], **more: Any) -> None:
    """Write NAME.md and NAME.json, each whole.

    ratios  by label, bigger is better; more: what else scripts may want
    Raises ValueError for a ratio that is no positive number.
    """
    bad = [label for label, ratio in ratios.items() if not (math.isfinite(ratio) and ratio > 0)]
    if bad:
        raise ValueError(f"no positive numbers: {', '.join(bad)}")
    write_text(FOLDER / f"{name}.md", "\n".join(lines).rstrip("\n") + "\n")
    rounded = {label: float(f"{ratio:.4g}") for label, ratio in ratios.items()}
    write_json(FOLDER / f"{name}.json", {"machine": machine(), "ratios": rounded, **more})


def spread(values: Sequence[float], digits: int = 2) -> str:
    """Median (least to most)."""
    low, middle, high = min(values), statistics.median(values), max(values)
    return f"{middle:.{digits}f} ({low:.{digits}f} to {high:.{digits}f})"
