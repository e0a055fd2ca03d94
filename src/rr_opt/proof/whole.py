"""A trial from its seed to its opened answers, going on behind what its journals have."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path

from rr_opt import __version__
from rr_opt.batch.journal import Journal
from rr_opt.lab.engines import Engine
from rr_opt.proof.commit import fingerprint
from rr_opt.proof.lots import draw_lot
from rr_opt.proof.opened import Opened, open_trial
from rr_opt.proof.trial import MADE, SAID, Run, Trial

PACKAGE = Path(__file__).parents[1]

Count = Callable[[str, Iterator[int], int], None]
"""Exhausts an iterator that yields a number for each case; told in words what is done with the
cases, and how many are done already."""


def whole_trial(
    folder: Path,
    seed: str,
    numbers: range,
    kinds: tuple[str, ...],
    engines: tuple[Engine, ...],
    *,
    keep: Callable[[Path, bytes], object],
    run: Run,
    count: Count,
    restart: bool = False,
) -> Opened:
    """Make every case, then diagnose every case, then open every answer.

    keep: writes a file whole; restart: what an earlier run left is forgotten. Raises InputError if
    the folder has another trial, or an answer that was changed.
    """
    code = fingerprint(PACKAGE)
    drawn = {"seed": seed, "kinds": list(kinds), "engines": list(engines)}
    identity = {**drawn, "code": code, "version": __version__}
    lots = [draw_lot(seed, number, kinds, engines) for number in numbers]
    trial = Trial(folder, keep, lots)
    with (
        Journal(folder / MADE, identity, restart=restart) as made,
        Journal(folder / SAID, identity, restart=restart) as said,
    ):
        count("made and sealed", trial.make(made, run), _done(made, numbers))
        count("diagnosed", trial.diagnose(made.rows, said, run), _done(said, numbers))
        opened = open_trial(folder, lots, made.rows, said.rows, identity)
    return replace(opened, changed=fingerprint(PACKAGE) != code)


def _done(journal: Journal, numbers: range) -> int:
    return sum(number in journal.rows for number in numbers)
