"""Write requirements/run.txt and requirements/dev.txt: exact versions of everything installed.

A fresh environment gets the newest versions that pyproject.toml allows; what is then there is
what is pinned. `dev.txt` includes `run.txt` and adds the extras and the tools.
"""

from __future__ import annotations

import subprocess
import sys
import tempfile
import tomllib
from pathlib import Path

ROOT = Path(__file__).parents[1]
PINS = ROOT / "requirements"
HEADER = "# Written by `make pins`. {}\n"


def main() -> None:
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
    build = project["build-system"]["requires"]
    core = project["project"]["dependencies"]
    extras = [need for of in project["project"]["optional-dependencies"].values() for need in of]
    with tempfile.TemporaryDirectory() as folder:
        python = Path(folder) / "bin" / "python"
        _call(sys.executable, "-m", "venv", folder)
        _call(python, "-m", "pip", "install", "-qq", "--upgrade", *build, *core)
        run = _installed(python)
        _call(python, "-m", "pip", "install", "-qq", *extras)
        dev = _installed(python)
    moved = [pin for pin in run if pin not in dev]
    if moved:
        sys.exit(f"The extras changed {', '.join(moved)}: give pyproject.toml narrower bounds.")
    run_header = HEADER.format("What `make run` needs.")
    dev_header = HEADER.format("What tests and checks need.") + "-r run.txt\n"
    _write("run.txt", run_header, run)
    _write("dev.txt", dev_header, [pin for pin in dev if pin not in run])


def _call(*command: str | Path) -> str:
    return subprocess.run(command, check=True, text=True, stdout=subprocess.PIPE).stdout


def _installed(python: Path) -> list[str]:
    return _call(python, "-m", "pip", "freeze", "--all", "--exclude", "pip").splitlines()


def _write(name: str, header: str, pins: list[str]) -> None:
    (PINS / name).write_text(header + "".join(f"{pin}\n" for pin in pins), encoding="utf-8")


if __name__ == "__main__":
    main()
