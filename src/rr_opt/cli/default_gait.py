"""What to say of a gait that nobody chose: that it is no optimum, and how to come to one."""

from __future__ import annotations

import shlex
from collections.abc import Container
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rr_opt.problem import GaitBounds
    from rr_opt.robot.gait import Gait


def doubts(
    path: Path | None, gait: Gait, bounds: GaitBounds | None, options: Container[str]
) -> tuple[str, ...]:
    """What a user may take for the optimum of a file (None: the prototype), in whole sentences.

    bounds   of the problem; None of a robot file
    options  those that were given: with amplitude and period the user has chosen the gait
    """
    from rr_opt.cli.problem_input import name_of  # noqa: PLC0415
    from rr_opt.report.quantities import with_unit  # noqa: PLC0415

    of = "the prototype" if path is None else str(path)
    units = {"amplitude": "rad", "period": "s"}
    defaults = [
        name
        for name in units
        if name not in options and not (bounds and getattr(bounds, name).fixed)
    ]
    shape = bounds.shape if bounds else "sine"
    told = []
    if defaults:
        values = [f"{name} {with_unit(getattr(gait, name), units[name])}" for name in defaults]
        told.append(
            f"No {' and '.join(defaults)} given. The default is driven, {' and '.join(values)} "
            f"after the paper's run, and not the optimum of {of}."
        )
    if shape != "sine":
        told.append(f"The problem asks for a `{shape}` gait, and a sine is driven.")
    if not told:
        return ()
    command = shlex.join(["rr-opt", "maximize-speed", *([] if path is None else [str(path)])])
    result = Path("out") / name_of(path) / "result.json"
    choice = ", or --amplitude and --period" if defaults else ""
    return (" ".join([*told, f"Run `{command}` first and give {result}{choice}."]),)
