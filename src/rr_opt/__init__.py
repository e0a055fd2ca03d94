"""rr-opt: the fastest gait of a Roller Racer, checked; and why a robot does something else.

    import rr_opt as rr

    problem = rr.load("my-problem.yaml")   # or rr.Problem(rr.prototype(), rr.Limits(rate="30 rpm"))
    best = rr.maximize_speed(problem)      # checked by simulation and against a plain sweep
    best.speed, best.gait, best.limits["rate"].shadow_price
    best.plot()
    best.save("out/")

    found = rr.diagnose("my-experiment/")  # or rr.Experiment.of(robot, runs)
    found.verdict, found.effects
    rr.maximize_speed(problem.with_robot(found.corrected_robot))

Numbers are in SI; constructors and functions also take text with a unit, such as "30 rpm". Errors
that a user can correct are raised as InputError. Modules are loaded on first use.

The paper behind the names: A. Kilin, Yu. Karavaev and K. Yefremov, "Experimental
investigations of the controlled motion of the Roller Racer robot".
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

from rr_opt.version import __version__

if TYPE_CHECKING:
    from rr_opt.api.drive import circle as circle
    from rr_opt.api.drive import export as export
    from rr_opt.api.drive import simulate as simulate
    from rr_opt.api.files import init as init
    from rr_opt.api.files import lint as lint
    from rr_opt.api.files import schema as schema
    from rr_opt.api.load import InputWarning as InputWarning
    from rr_opt.api.load import RobotWithGait as RobotWithGait
    from rr_opt.api.load import load as load
    from rr_opt.api.load import load_experiment as load_experiment
    from rr_opt.api.load import load_gait as load_gait
    from rr_opt.api.load import load_robot as load_robot
    from rr_opt.api.load import prototype as prototype
    from rr_opt.api.load import shipped as shipped
    from rr_opt.api.optimise import maximize_speed as maximize_speed
    from rr_opt.api.optimise import shapes as shapes
    from rr_opt.api.optimise import sweep as sweep
    from rr_opt.api.recordings import diagnose as diagnose
    from rr_opt.api.recordings import inspect as inspect
    from rr_opt.api.route import load_route as load_route
    from rr_opt.api.route import load_routes as load_routes
    from rr_opt.api.route import route as route
    from rr_opt.api.route import routes as routes
    from rr_opt.api.study import load_study as load_study
    from rr_opt.api.study import study as study
    from rr_opt.api.turn import turn as turn
    from rr_opt.api.turn import turn_chart as turn_chart
    from rr_opt.model.experiment import Experiment as Experiment
    from rr_opt.model.experiment import Noise as Noise
    from rr_opt.model.experiment import Recording as Recording
    from rr_opt.model.experiment import Run as Run
    from rr_opt.model.gait import FourierGait as FourierGait
    from rr_opt.model.gait import FreeGait as FreeGait
    from rr_opt.model.gait import Gait as Gait
    from rr_opt.model.gait import SineGait as SineGait
    from rr_opt.model.problem import GaitBounds as GaitBounds
    from rr_opt.model.problem import Limits as Limits
    from rr_opt.model.problem import Problem as Problem
    from rr_opt.model.problem import RatioChoice as RatioChoice
    from rr_opt.model.robot import EffectUse as EffectUse
    from rr_opt.model.robot import Platform as Platform
    from rr_opt.model.robot import Robot as Robot
    from rr_opt.model.robot import Servo as Servo
    from rr_opt.model.route import Arc as Arc
    from rr_opt.model.route import Pose as Pose
    from rr_opt.model.route import Route as Route
    from rr_opt.model.route import Straight as Straight
    from rr_opt.model.route import Tolerance as Tolerance
    from rr_opt.model.route import Waypoint as Waypoint
    from rr_opt.outcome import InputError as InputError
    from rr_opt.outcome import NotConvergedError as NotConvergedError
    from rr_opt.outcome import Status as Status
    from rr_opt.results.diagnosis import ExplainedExperiment as ExplainedExperiment
    from rr_opt.results.fastest import FastestGait as FastestGait
    from rr_opt.results.inspection import InspectedRecordings as InspectedRecordings
    from rr_opt.results.motion import DrivenCircle as DrivenCircle
    from rr_opt.results.motion import SimulatedMotion as SimulatedMotion
    from rr_opt.results.route import DrivenRoute as DrivenRoute
    from rr_opt.results.setpoints import ExportedGait as ExportedGait
    from rr_opt.results.shapes import FastestShapes as FastestShapes
    from rr_opt.results.study import DrivenRoutes as DrivenRoutes
    from rr_opt.results.study import SolvedStudy as SolvedStudy
    from rr_opt.results.sweep import Sweep as Sweep
    from rr_opt.results.turn import FastestTurn as FastestTurn
    from rr_opt.results.turn import TurnChart as TurnChart

_HOMES = {
    "api.drive": "circle export simulate",
    "api.files": "init lint schema",
    "api.load": "InputWarning RobotWithGait load load_experiment "
    "load_gait load_robot prototype shipped",
    "api.optimise": "maximize_speed shapes sweep",
    "api.recordings": "diagnose inspect",
    "api.route": "load_route load_routes route routes",
    "api.study": "load_study study",
    "api.turn": "turn turn_chart",
    "model.experiment": "Experiment Noise Recording Run",
    "model.gait": "FourierGait FreeGait Gait SineGait",
    "model.problem": "GaitBounds Limits Problem RatioChoice",
    "model.robot": "EffectUse Platform Robot Servo",
    "model.route": "Arc Pose Route Straight Tolerance Waypoint",
    "outcome": "InputError NotConvergedError Status",
    "results.diagnosis": "ExplainedExperiment",
    "results.fastest": "FastestGait",
    "results.inspection": "InspectedRecordings",
    "results.motion": "DrivenCircle SimulatedMotion",
    "results.route": "DrivenRoute",
    "results.setpoints": "ExportedGait",
    "results.shapes": "FastestShapes",
    "results.study": "DrivenRoutes SolvedStudy",
    "results.sweep": "Sweep",
    "results.turn": "FastestTurn TurnChart",
}
"""Public names by the module that has them."""
_MODULE_OF = {name: module for module, names in _HOMES.items() for name in names.split()}

__all__ = ["__version__", *_MODULE_OF]  # noqa: PLE0604 # pyright: ignore[reportUnsupportedDunderAll]


def __getattr__(name: str) -> Any:
    """A public name, loaded now (PEP 562): a plain `import rr_opt` loads nothing."""
    if name not in _MODULE_OF:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(f"{__name__}.{_MODULE_OF[name]}"), name)


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
