"""Run every command that Markdown files show, in order, and hold what it shows against them.

A fenced block means, by its language:

sh      commands, one a line. `make` runs at the root of the checkout, all else in one temporary
        folder. A command that fails ends the run.
python  a script, run in the folder.
yaml    a file, whose name is in its first line as a comment; it is written to the folder.
text    lines that the commands of the `sh` block before it print, in this order and among
        others. Numbers may differ by one part in a thousand.
"""

from __future__ import annotations

import math
import os
import re
import subprocess
import sys
import tempfile
from dataclasses import dataclass, replace
from pathlib import Path

ROOT = Path(__file__).parents[1]
PROGRAMS = ("make", "rr-opt")

_BLOCK = re.compile(r"^```(\w*)\n(.*?)^```$", re.MULTILINE | re.DOTALL)
_NUMBER = re.compile(r"[-+]?\d+(?:\.\d+)?(?:e[-+]?\d+)?")


@dataclass(frozen=True)
class File:
    """A file that is shown."""

    name: str
    text: str


@dataclass(frozen=True)
class Commands:
    """Commands that are shown, and lines they are said to print."""

    lines: tuple[str, ...]
    printed: tuple[str, ...] = ()


@dataclass(frozen=True)
class Script:
    """Python code that is shown."""

    text: str


def blocks(markdown: str) -> list[tuple[str, str]]:
    """Language and text of every fenced block."""
    return _BLOCK.findall(markdown)


def steps(markdown: str) -> list[File | Commands | Script]:
    """What a reader who follows the text does. Raises ValueError for a block without meaning."""
    found: list[File | Commands | Script] = []
    for language, text in blocks(markdown):
        if language == "sh":
            found.append(Commands(tuple(_commands(text))))
        elif language == "python":
            found.append(Script(text))
        elif language == "yaml":
            name = re.match(r"# (\S+\.yaml)\n", text)
            if name is None:
                raise ValueError(f"A yaml block starts with `# NAME.yaml`; got:\n{text}")
            found.append(File(name[1], text))
        elif language == "text" and found and isinstance(found[-1], Commands):
            lines = tuple(line for line in text.splitlines() if line.strip(" ."))
            found[-1] = replace(found[-1], printed=lines)
        else:
            raise ValueError(
                f"A block is sh, python, yaml, or text after sh; got `{language}`:\n{text}"
            )
    return found


def missing(expected: tuple[str, ...], printed: str) -> str | None:
    """The first of the expected lines that is not printed after those before it."""
    rest = iter(printed.splitlines())
    for line in expected:
        if not any(_alike(line, other) for other in rest):
            return line
    return None


def _commands(text: str) -> list[str]:
    lines = [line.partition("  #")[0].strip() for line in text.splitlines()]
    lines = [line for line in lines if line and not line.startswith("#")]
    for line in lines:
        if line.split()[0] not in PROGRAMS:
            raise ValueError(f"A command starts with {' or '.join(PROGRAMS)}; got: {line}")
    return lines


def _alike(one: str, other: str) -> bool:
    words = [_NUMBER.sub("0", line).split() for line in (one, other)]
    numbers = [[float(number) for number in _NUMBER.findall(line)] for line in (one, other)]
    return words[0] == words[1] and all(
        math.isclose(a, b, rel_tol=1e-3, abs_tol=1e-9) for a, b in zip(*numbers, strict=True)
    )


def _run(step: Commands, folder: Path) -> None:
    environment = {k: v for k, v in os.environ.items() if not k.startswith(("MAKE", "MFLAGS"))}
    environment["PATH"] = f"{Path(sys.executable).parent}{os.pathsep}{environment['PATH']}"
    printed = ""
    for line in step.lines:
        print(f"$ {line}", flush=True)
        place = ROOT if line.startswith("make") else folder
        run = subprocess.run(
            line,
            shell=True,
            cwd=place,
            env=environment,
            text=True,
            stdout=subprocess.PIPE,
            check=False,
        )
        print(run.stdout, flush=True)
        if run.returncode:
            sys.exit(f"`{line}` ended with exit code {run.returncode}.")
        printed += run.stdout
    lost = missing(step.printed, printed)
    if lost is not None:
        sys.exit(f"Shown, but not printed in this order: {lost}")


def main() -> None:
    for page in sys.argv[1:]:
        _follow(steps(Path(page).read_text(encoding="utf-8")))


def _follow(given: list[File | Commands | Script]) -> None:
    """Do the steps of one page, in a folder of its own."""
    with tempfile.TemporaryDirectory() as folder:
        for step in given:
            if isinstance(step, File):
                (Path(folder) / step.name).write_text(step.text, encoding="utf-8")
            elif isinstance(step, Script):
                print(step.text, flush=True)
                subprocess.run([sys.executable, "-c", step.text], cwd=folder, check=True)
            else:
                _run(step, Path(folder))


if __name__ == "__main__":
    main()
