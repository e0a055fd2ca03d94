"""A machine that can be diagnosed: its equations, with units and words for all they contain.

A machine is data. Its equations are functions of names: states, inputs, parameters. Effects enter
through ports, each a place where something may be missing.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from types import SimpleNamespace
from typing import Any

import numpy as np

from rr_opt.array import Array
from rr_opt.model.parameters import Spread, Uncertainty

Names = SimpleNamespace
"""States, inputs, parameters or constants by name: CasADi's, or arrays."""

Add = Callable[..., Any]
"""add(port, ...) is what the effects add at a port; they also see the names given as arguments."""

Signals = Mapping[str, Array]
"""Inputs (n,) by name."""

Scales = Mapping[str, float]
"""Usual sizes, such as of a torque and a speed, by name."""


@dataclass(frozen=True)
class MachineParameter:
    """A number of the nominal model.

    spread     how well it is usually known
    low, high  bounds, SI
    default    if a file does not give it; None: required
    """

    name: str
    unit: str
    words: str
    example: str
    spread: Spread
    low: float = 0.0
    high: float = np.inf
    default: float | None = None


@dataclass(frozen=True)
class Channel:
    """What is recorded: an output that is predicted, or an input that drives the machine.

    default  value of an input that is not recorded; None: required
    angle    whole turns do not count
    steady   changes between two updates, as measured inputs do; a command is held
    """

    name: str
    unit: str
    words: str
    default: float | None = None
    angle: bool = False
    steady: bool = False


@dataclass(frozen=True)
class Constant:
    """A number of an effect, which vanishes at 0.

    size   its usual size, as a function of the machine's usual sizes
    begin  initial guess, in usual sizes
    """

    name: str
    unit: str
    size: Callable[[Scales], float]
    low: float = 0.0
    high: float = 1e3
    begin: float = 0.05


@dataclass(frozen=True)
class MachineEffect:
    """An effect that may be missing from a machine's model.

    port        where it enters: a port of the equations, or "signal", which changes the inputs
    law         (names, constants) -> what it adds at its port; of a signal
                (t, inputs, constants) -> the inputs that it changes
    words       as the object of a sentence
    forms       names of the constants that each of its forms has, the simplest first; none
                given, it has one form with all of them
    smooth      whether it is differentiable in its constants where it vanishes
    form_error  relative deviation of machines from this law
    """

    name: str
    family: str
    channel: str
    port: str
    words: str
    sentence: str
    constants: tuple[Constant, ...]
    law: Callable[..., Any]
    forms: tuple[tuple[str, ...], ...] = ()
    smooth: bool = True
    form_error: float = 0.1

    def quantity(self, constant: str) -> str:
        """The full name of a constant; if the effect has no name, that of a parameter."""
        return f"{self.name}.{constant}" if self.name else constant


@dataclass(frozen=True, eq=False)
class Machine:
    """A kind of machine.

    states    in order; the last `stiff` of them may be stiff
    rates     (names, add) -> d(state)/dt by name
    seen      (names, add) -> outputs by name
    rate_of   by state that is no output: the output that it moves
    start     (outputs and their slopes, `q` and `q_rate`, and inputs) -> states where a run begins
    signals   what inputs go through before they drive it, with parameters as its constants
    scales    (parameters, inputs, outputs' rates; RMS each) -> usual sizes for the effects
    ports     by channel of a fault: port, unit and words of an unknown input there
    variables what an unknown input may depend on: name of a state or input -> words and unit
    step      longest integration step, s
    bandwidth Hz; anything faster is noise
    """

    name: str
    words: str
    equation: str
    states: tuple[str, ...]
    parameters: tuple[MachineParameter, ...]
    inputs: tuple[Channel, ...]
    outputs: tuple[Channel, ...]
    effects: tuple[MachineEffect, ...]
    rates: Callable[[Names, Add], Mapping[str, Any]]
    seen: Callable[[Names, Add], Mapping[str, Any]]
    rate_of: Mapping[str, str]
    start: Callable[[Mapping[str, float]], Mapping[str, float]]
    scales: Callable[[Mapping[str, float]], Scales]
    ports: Mapping[str, tuple[str, str, str]]
    variables: Mapping[str, tuple[str, str]]
    signals: tuple[MachineEffect, ...] = ()
    step: float = 1e-3
    stiff: int = 1
    bandwidth: float = 15.0

    @property
    def channels(self) -> tuple[Channel, ...]:
        """Inputs and outputs."""
        return (*self.inputs, *self.outputs)

    def effect(self, name: str) -> MachineEffect:
        """The effect of a name."""
        return next(one for one in self.effects if one.name == name)

    def parameter(self, name: str) -> MachineParameter | None:
        """The parameter of a name."""
        return next((one for one in self.parameters if one.name == name), None)


@dataclass(frozen=True)
class MachineRun:
    """A recording of a machine: t (n,) s; inputs and outputs (n,) SI by name, NaN for no data.

    sigma   of the noise of each channel
    held    samples for which inputs stand still from one update to the next
    doubts  sentences on what looked wrong in it
    """

    name: str
    t: Array
    inputs: Signals
    outputs: Signals
    sigma: Mapping[str, float]
    held_out: bool = False
    doubts: tuple[str, ...] = ()
    held: int = 1

    def __len__(self) -> int:
        return len(self.t)


@dataclass(frozen=True)
class MachineExperiment:
    """A machine as it is believed to be, and recordings of it.

    nominal      parameters by name, SI, and what was found to be missing before, as
                 `coulomb_friction.torque`
    uncertainty  by parameter; what is not named is exact
    """

    machine: Machine
    nominal: Mapping[str, float]
    uncertainty: Mapping[str, Uncertainty]
    runs: tuple[MachineRun, ...]
    name: str = ""
    sha256: str = ""
