"""What a file describes, told from its keys."""

from __future__ import annotations

from typing import Literal

from rr_opt.files.document import Document
from rr_opt.files.issue import nearest
from rr_opt.files.problem_model import ProblemModel
from rr_opt.files.result_text import is_result
from rr_opt.files.robot_model import RobotModel

Kind = Literal["robot", "problem", "study", "experiment", "result"]

_EXPERIMENT = ("recordings", "noise", "uncertainty")
_STUDY = ("vary", "together", "problem")


def kind_of(document: Document) -> Kind:
    """The kind whose keys the file has most of; misspelt keys count too, and a tie is a problem."""
    if is_result(document.data):
        return "result"
    if any(key in document.data for key in _EXPERIMENT):
        return "experiment"
    if any(key in document.data for key in _STUDY):
        return "study"
    robot, problem = list(RobotModel.model_fields), list(ProblemModel.model_fields)
    meant = [nearest(key, [*robot, *problem]) for key in document.data]
    of_robot = sum(key in robot for key in meant)
    return "robot" if of_robot > sum(key in problem for key in meant) else "problem"
