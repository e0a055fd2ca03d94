"""The JSON Schemas of the input files, with which editors complete and check them."""

from typing import Any, Literal, get_args

from pydantic import BaseModel

from rr_opt.files.experiment_model import ExperimentModel
from rr_opt.files.problem_model import ProblemModel, StudyModel
from rr_opt.files.robot_file import RobotModel
from rr_opt.files.route_file import RouteModel
from rr_opt.messages import unknown_word
from rr_opt.outcome import InputError

FileKind = Literal["robot", "problem", "study", "experiment", "route"]

_DIALECT = "https://json-schema.org/draft/2020-12/schema"
_MODELS: dict[str, type[BaseModel]] = {
    "robot": RobotModel,
    "problem": ProblemModel,
    "study": StudyModel,
    "experiment": ExperimentModel,
    "route": RouteModel,
}


def schema(kind: str) -> dict[str, Any]:
    """The JSON Schema (2020-12) of a kind of file: robot, problem, study, experiment or route.

    Every field carries a description with its unit; the SI unit alone is under `x-unit`.
    Raises InputError for any other kind.
    """
    if kind not in _MODELS:
        raise InputError(unknown_word(kind, get_args(FileKind), "kind of file"))
    return schema_of(_MODELS[kind], kind)


def schema_of(model: type[BaseModel], kind: str) -> dict[str, Any]:
    """The JSON Schema of a kind of file with these keys."""
    generated = model.model_json_schema()
    return {"$schema": _DIALECT, "title": f"rr-opt {kind} file", **_tidied(generated)}


def _tidied(node: Any) -> Any:
    """Without pydantic's titles, and without null as the default of a key that may be absent."""
    if isinstance(node, list):
        return [_tidied(item) for item in node]
    if not isinstance(node, dict):
        return node
    return {
        key: _tidied(value)
        for key, value in node.items()
        if not (key == "default" and value is None)
        and not (key == "title" and isinstance(value, str))
    }
