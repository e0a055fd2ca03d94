"""Shapes of gaits: what each adds to the unknowns and rows of multiple shooting."""

from rr_opt.design.shapes.fourier import FourierShape
from rr_opt.design.shapes.free import FreeShape
from rr_opt.design.shapes.shape import Shape
from rr_opt.model.problem import GaitBounds


def shape_of(gait: GaitBounds) -> Shape:
    """The shape that a problem asks for, which is no sine."""
    if gait.shape == "fourier":
        return FourierShape(gait.harmonics)
    return FreeShape()
