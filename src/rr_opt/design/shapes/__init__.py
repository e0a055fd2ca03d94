"""Shapes of gaits: what each adds to the unknowns and rows of multiple shooting.

phi is a function of the phase theta alone, given the shape's decisions and, for a shape that is
not one formula, unknowns at every node. Rates are in radians per period until the period divides
them, so that it does not get into the shape. A shape is hashable, as programs are kept by shape:

    decisions    unknowns that hold for the whole period, beside period, ballast and turn
    states       unknowns at every node that an interval carries on to the next
    controls     unknowns at every node, constant over the interval that begins there
    integrals    means over the period, of `integrands`, that rows and bounds need
    limits       rows that hold once a period: `limit_rows`
    path         rows at every node: `path_rows`, of the interval from theta on, and at a place
    checks       how many numbers it is given, such as phases, that `limits` depend on: `given`
    angle        phi, dphi/dtheta, d2phi/dtheta2 (rad) at phase theta, `since` after the node
    bounds       what a problem says of these unknowns and rows
    start, gait  the unknowns of a gait, or of one close to it, and the gait of a solution
    prices, bound_prices  speed gained per unit of the limits on rate, angle and singularity, and
                 per unit by which an active bound of amplitude or offset moves up
"""

from rr_opt.design.shapes.fourier import FourierShape
from rr_opt.design.shapes.free import FreeShape
from rr_opt.model.problem import GaitBounds

Shape = FourierShape | FreeShape


def shape_of(gait: GaitBounds) -> Shape:
    """The shape that a problem asks for, which is no sine."""
    return FourierShape(gait.harmonics) if gait.shape == "fourier" else FreeShape()
