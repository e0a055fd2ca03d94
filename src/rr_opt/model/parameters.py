"""The parameters of the robot: what each is, its unit, and how well it is usually known.

`m` is the mass of either platform, `m1` and `m2` are those of platforms 1 and 2. Files, fits,
reports and the laboratory all take names, units, words and default uncertainties from here.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from rr_opt.units import Number

if TYPE_CHECKING:
    from rr_opt.model.robot import Robot


@dataclass(frozen=True)
class Uncertainty:
    """How well a nominal value is known.

    sigma   one standard deviation, SI; unused with `factor`
    factor  the value lies between value/factor and value*factor, and nothing more is known; if it
            is 0, up to that many times its usual size
    """

    sigma: float = 0.0
    factor: float | None = None

    @property
    def exact(self) -> bool:
        """Whether the value is known exactly."""
        return not (self.sigma or self.factor)


UNKNOWN_FACTOR = 5.0
"""A value declared `unknown` is free within this factor of its nominal value."""


@dataclass(frozen=True)
class Spread:
    """An uncertainty as specified: absolute (SI), a share of the nominal value, or a factor."""

    sigma: float = 0.0
    relative: float = 0.0
    factor: float | None = None

    def of(self, nominal: float) -> Uncertainty:
        """The uncertainty of a value with this nominal."""
        return Uncertainty(self.sigma + self.relative * abs(nominal), self.factor)

    def __str__(self) -> str:
        if self.factor is not None:
            return "unknown"
        return f"{100 * self.relative:g} %" if self.relative else f"{1e3 * self.sigma:g} mm"


@dataclass(frozen=True)
class RobotParameter:
    """A parameter of the robot.

    symbol       as in the paper: m, I, c, a, b, kappa, h
    unit         SI, as pint reads it
    words        what it is called; `plural` for both platforms
    definition   a phrase that defines it
    example      how a user might write the value; `sigma_example` an absolute uncertainty
    uncertainty  the default, one sigma
    above        exclusive lower bound; `at_least`: inclusive
    platform     1 or 2; None for h, and for a symbol that stands for both
    """

    symbol: str
    unit: str
    words: str
    plural: str
    definition: str
    example: str
    uncertainty: Spread
    sigma_example: str
    above: float | None = None
    at_least: float | None = None
    platform: int | None = None

    @property
    def name(self) -> str:
        """`kappa1`."""
        return f"{self.symbol}{self.platform or ''}"

    @property
    def key(self) -> tuple[str, ...]:
        """Its place in a robot and in a robot file: (`platform1`, `kappa`)."""
        return (
            (self.symbol,) if self.platform is None else (f"platform{self.platform}", self.symbol)
        )

    @property
    def quantity(self) -> Number:
        """Its unit and range."""
        return Number(self.unit, self.example, above=self.above, at_least=self.at_least)

    @property
    def description(self) -> str:
        """Its definition with the unit, as a sentence."""
        return f"{self.definition}, {self.unit.replace('^', '')}."

    @property
    def full_words(self) -> str:
        """`viscous wheel friction of platform 1`."""
        return f"{self.words} of platform {self.platform}" if self.platform else self.words


# fmt: off
_TABLE = (
    RobotParameter("m", "kg", "mass", "masses", "Mass",
              "469 g", Spread(relative=0.01), "5 g", above=0),
    RobotParameter("I", "kg m^2", "moment of inertia", "moments of inertia",
              "Moment of inertia about the vertical through the centre of mass",
              "0.00386", Spread(relative=0.05), "1e-4", above=0),
    RobotParameter("c", "m", "distance from axle to joint", "distances from axle to joint",
              "Distance from the axle's centre to the joint P",
              "186 mm", Spread(2e-3), "2 mm", above=0),
    RobotParameter("a", "m", "distance from axle to centre of mass",
              "distances from axle to centre of mass",
              "Distance from the axle's centre to the centre of mass, towards P",
              "20 mm", Spread(2e-3), "2 mm"),
    RobotParameter("b", "m", "half track", "half tracks",
              "Half track: from the axle's centre to each wheel",
              "50 mm", Spread(2e-3), "2 mm", above=0),
    # Bearings and tyres of one design differ more than any datasheet says: recordings decide.
    RobotParameter("kappa", "N m s", "viscous wheel friction", "viscous wheel frictions",
              "Viscous friction of one wheel about its axle",
              "6.2e-5", Spread(factor=UNKNOWN_FACTOR), "1e-6", at_least=0),
    RobotParameter("h", "m", "wheel radius", "wheel radii", "Wheel radius",
              "20 mm", Spread(5e-4), "0.5 mm", above=0),
)
# fmt: on

SYMBOLS = {one.symbol: one for one in _TABLE}
"""By symbol; all but h exist once for each platform."""

PLATFORM_SYMBOLS = tuple(symbol for symbol in SYMBOLS if symbol != "h")

PARAMETERS = {
    one.name: one
    for one in (
        *(replace(SYMBOLS[s], platform=number) for number in (1, 2) for s in PLATFORM_SYMBOLS),
        SYMBOLS["h"],
    )
}
"""By name, in the order m1, I1, c1, a1, b1, kappa1, m2, ..., kappa2, h."""


def parameters_of(robot: Robot) -> dict[str, float]:
    """The value of each parameter by name, SI, in the order of PARAMETERS."""
    owners = {1: robot.platform1, 2: robot.platform2, None: robot}
    return {name: getattr(owners[one.platform], one.symbol) for name, one in PARAMETERS.items()}


def with_parameters(robot: Robot, values: Mapping[str, float]) -> Robot:
    """The robot with the named parameters changed; values in SI.

    Raises KeyError for a name that is not in PARAMETERS.
    """
    changes: dict[int | None, dict[str, float]] = {1: {}, 2: {}, None: {}}
    for name, value in values.items():
        parameter = PARAMETERS[name]
        changes[parameter.platform][parameter.symbol] = value
    return replace(
        robot,
        platform1=replace(robot.platform1, **changes[1]),
        platform2=replace(robot.platform2, **changes[2]),
        **changes[None],
    )


def default_uncertainty(robot: Robot) -> dict[str, Uncertainty]:
    """The uncertainty of each parameter where nothing is specified, by name."""
    return {
        name: PARAMETERS[name].uncertainty.of(value) for name, value in parameters_of(robot).items()
    }
