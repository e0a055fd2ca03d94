"""What an effect is: data, and the one port where it enters the mechanism."""

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from enum import StrEnum

import casadi as ca

from rr_opt.mechanics.drive import Drive, FreeJoint
from rr_opt.mechanics.kinematics import Mechanism, Observation
from rr_opt.model.robot import Robot
from rr_opt.model.servo_command import LinearServo


class Port(StrEnum):
    """Where an effect enters."""

    ACTUATION = "actuation"
    CONSTRAINT = "constraint"
    FORCE = "force"
    MASS = "mass"
    MEASUREMENT = "measurement"


@dataclass(frozen=True)
class OperatingRange:
    """A robot and the range over which it is operated: what the size of an effect scales with.

    rate    largest rate asked of the servo, rad/s
    speed   largest speed of the wheels, m/s
    extent  of the floor that it covers, m
    """

    robot: Robot
    rate: float
    speed: float
    extent: float = math.inf


@dataclass(frozen=True)
class Parameter:
    """A parameter of an effect.

    unit              as pint reads it
    bounds            within which it makes sense, in that unit
    typical           usual magnitude on the paper's prototype
    neutral           the value at which the effect vanishes
    aliases           other names for it in robot files
    typical_for       usual magnitude for a given operating range, where `typical` does not scale
    initial_guesses   where a fit starts: distances from neutral in units of the usual magnitude,
                      or multiples of that magnitude if neutral is not zero. Several where a fit
                      from the first may end in a local minimum or on a plateau
    guess_from_data   only the recordings say where a fit should start: a place on the floor, a grip
    model_form_sigma  relative spread of its value between real machines, 1 sigma
    fit_lower         a fit goes no lower: there the effect turns into another
    fit_upper         a fit goes no higher, for a given operating range
    costly            its terms take as long to evaluate as all others: while it is neutral,
                      predictions leave them out
    sharp             while it is not neutral, forces or the drive bend so sharply that predictions
                      need shorter steps
    """

    name: str
    unit: str
    bounds: tuple[float, float]
    typical: float
    neutral: float = 0.0
    aliases: tuple[str, ...] = ()
    typical_for: Callable[[OperatingRange], float] | None = None
    initial_guesses: tuple[float, ...] = (0.05,)
    guess_from_data: bool = False
    model_form_sigma: float = 0.0
    fit_lower: float = -math.inf
    fit_upper: Callable[[OperatingRange], float] | None = None
    costly: bool = False
    sharp: bool = False

    def magnitude(self, operated: OperatingRange) -> float:
        """Usual magnitude for an operating range."""
        return self.typical_for(operated) if self.typical_for else self.typical


ActuateAll = Callable[
    [Sequence[Drive], Sequence[Mapping[str, float]], Sequence[FreeJoint | None]], list[Drive]
]


@dataclass(frozen=True)
class Effect:
    """An effect of physics beyond the paper's model.

    family      its group in the catalogue
    parameters  in the order in which robot files and reports list them
    sentence    what it is, for a person

    One of these, which makes the effect what it is; `symbols` and `values` map each parameter's
    name to its symbol or its value, SI:
    enter       (mechanism, symbols) -> the mechanism with it: ports constraint, mass and force
    actuate     (command, values, joint) -> what the servo makes of its command: port actuation.
                joint: how it moves while the servo exerts no torque; None if that is not known
    actuate_all  the same of several commands with their values, where that is faster
    frees_joint  the servo lets go of the joint at times, which then moves as the mechanism does
    linear      (values) -> the same as a linear servo, where it is one: gaits are then optimised
                with it
    observe     (observation, symbols) -> what is recorded: port measurement
    delay       name of the parameter by which the recording's clock lags the command's: port
                measurement

    For predictions and fits:
    stiff               it lets the axles slip, which they stop doing within milliseconds
    near_discontinuous  its force all but jumps with the speed, so predictions need short steps
    accelerated         it needs the joint's acceleration though the axles do not slip
    differentiable      the prediction is differentiable in its parameters where it vanishes
    tangent             if not: the effect that equals it to first order in its first form
    candidate           a diagnosis may propose it; not so a curve fit without a physical meaning,
                        what the experiment states of itself, a lookalike or a tangent of others
    forms               which parameters are fitted together; without any, all of them
    form_error          relative deviation of real machines from this model of it: larger for
                        contacts and stops, for which many laws exist
    lookalikes          effects that are no candidates and move a robot much as this does: none may
                        predict better if this is to be named
    unmodelled          what has no model here and moves a robot much as this does, in words
    """

    name: str
    family: str
    port: Port
    parameters: tuple[Parameter, ...]
    sentence: str
    enter: Callable[[Mechanism, Mapping[str, ca.SX]], Mechanism] | None = None
    actuate: Callable[..., Drive] | None = None
    actuate_all: ActuateAll | None = None
    frees_joint: bool = False
    linear: Callable[[Mapping[str, float]], LinearServo] | None = None
    observe: Callable[[Observation, Mapping[str, ca.SX]], Observation] | None = None
    delay: str | None = None
    stiff: bool = False
    accelerated: bool = False
    near_discontinuous: bool = False
    differentiable: bool = True
    tangent: str = ""
    candidate: bool = True
    forms: tuple[tuple[str, ...], ...] = ()
    form_error: float = 0.02
    lookalikes: tuple[str, ...] = ()
    unmodelled: tuple[str, ...] = ()

    def actuated(
        self,
        commands: Sequence[Drive],
        values: Sequence[Mapping[str, float]],
        joints: Sequence[FreeJoint | None],
    ) -> list[Drive]:
        """What the servo makes of each command, with the values and the joint of each."""
        if self.actuate_all:
            return self.actuate_all(commands, values, joints)
        actuate = self.actuate or (lambda command, *_: command)
        return [actuate(*one) for one in zip(commands, values, joints, strict=True)]
