"""Which packages a verb loads and never enters: `-m benchmarks.startup.loaded FILE VERB ...`.

The verb runs under a profile. A package counts as used if any of its functions is called, in
Python or in C, while nothing is being imported. What is found is written to FILE as JSON:
`unused`, the names of packages that were loaded and not used. With `-X importtime` the
interpreter tells on stderr what each took.
"""

from __future__ import annotations

import json
import sys
from pathlib import Path
from types import FrameType
from typing import Any

_IMPORTING = frozenset({"_find_and_load", "import_module", "_gcd_import"})


class Use:
    """A profile that notes the modules whose functions are called while nothing is imported."""

    def __init__(self) -> None:
        self.entered: set[str] = set()
        self._importing = 0

    def __call__(self, frame: FrameType, event: str, given: Any) -> None:
        """As `sys.setprofile` wants it."""
        if event == "c_call":
            if not self._importing:
                self.entered.add(getattr(given, "__module__", None) or _owner(given))
            return
        if event == "c_return":
            return
        if frame.f_code.co_name in _IMPORTING:
            self._importing += {"call": 1, "return": -1}.get(event, 0)
        elif event == "call" and not self._importing:
            self.entered.add(frame.f_globals.get("__name__", ""))


def _owner(function: Any) -> str:
    """The module of a method's class."""
    return type(getattr(function, "__self__", None)).__module__


def package(module: str) -> str:
    """The name that is told: rr_opt by its packages, others by their first name."""
    parts = module.split(".")
    return ".".join(parts[:2]) if parts[0] == "rr_opt" else parts[0]


def main() -> None:
    """Run the verb, and write what was not used."""
    file, *arguments = sys.argv[1:]
    sys.argv = ["rr-opt", *arguments]
    use = Use()
    sys.setprofile(use)
    try:
        from rr_opt.cli.entry import main as run

        run()
    except SystemExit:
        pass
    finally:
        sys.setprofile(None)
        used = {package(name) for name in use.entered}
        own = set(sys.stdlib_module_names) | {"benchmarks", "__main__"}
        there = {package(name) for name in list(sys.modules)} - own
        Path(file).write_text(json.dumps({"unused": sorted(there - used)}), encoding="utf-8")


if __name__ == "__main__":
    main()
