"""A machine: a model that also proposes what it may lack, and says what an answer is worth."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Protocol

from rr_opt.array import Array
from rr_opt.sysid.diagnosis import Misfit, NextExperiment
from rr_opt.sysid.estimation import Fit
from rr_opt.sysid.model import ChannelNoise, Choice, Linearisation, Model, Segment

CONSTANT = "nothing"
"""The variable of an input that is constant."""


@dataclass(frozen=True)
class Term:
    """An unknown input in a channel as functions of a variable.

    columns  its columns of the linearisation, counted after the quantities
    unit     of the variable;  at (k,) points where the input is evaluated;  shapes (k, columns) its
             basis functions there
    """

    channel: str
    variable: str
    columns: tuple[int, ...]
    unit: str
    at: Array
    shapes: Array


class MachineModel(Model, Protocol):
    """A model with ways to propose what is missing from it.

    inputs          channels through which an unknown input may enter, and each input in words
    """

    @property
    def inputs(self) -> Mapping[str, str]: ...  # noqa: D102

    def upstream(self) -> Sequence[tuple[tuple[Choice, ...], Mapping[str, float]]]:
        """Sets of drive effects, with values, that explain the drive's own recording; the simplest
        first among equals. One empty set if the nominal drive explains it."""
        ...

    def proposals(
        self, fit: Fit, complete: Sequence[str]
    ) -> Sequence[tuple[Choice, Mapping[str, float]]]:
        """Initial guesses of effects that a score test cannot detect, given a fit without them."""
        ...

    def with_noise(self, noise: Sequence[ChannelNoise]) -> MachineModel:
        """The same machine and runs with other noise in each channel, relative to the present."""
        ...

    def unknown_inputs(self, fit: Fit) -> tuple[Sequence[Term], Mapping[Segment, Linearisation]]:
        """Unknown inputs that a fit may lack, as functions of what they may depend on; and the
        fit's segments linearised in the quantities and in these functions."""
        ...

    def equivalent(self, values: Mapping[str, float]) -> Mapping[str, float] | None:
        """Values that predict the same and are nearer to the nominal ones, if there are any."""
        ...

    def next_experiment(self, best: Fit, rival: tuple[str, Fit] | None) -> NextExperiment | None:
        """The recording that would best discriminate between the answer and its rival, the
        runner-up with its name; or that would most narrow the least certain value; None if no
        recording would."""
        ...

    def worth(self, before: Sequence[Misfit], after: Sequence[Misfit]) -> str:
        """What the answer is worth in the machine's own terms, as the beginning of a sentence: `the
        simulated place was 8 mm off and is 1 mm off now; `."""
        ...

    def accuracy(self, misfits: Sequence[Misfit]) -> str:
        """How well the corrected model predicts, in the machine's own terms, as a sentence."""
        ...
