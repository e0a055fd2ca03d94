"""What each wheel carries.

The robot stands on four wheels, on a joint that turns about the vertical alone: a stiff body, whose
weight and whose two moments on the floor give three conditions for four loads. Of all loads that
keep them, those are taken whose squares are least: the loads of four equal springs. Without a mass
beside the axis the wheels of an axle share alike, and of platform 1's axle

    N1 = g (m1 (c1 + c2 - a1) + m2 a2) / (c1 + c2)

Assumed: the posture is straight (at 0.9 rad the axles carry another half a per cent), the floor is
nearly level, and the masses are low, so that braking and turning move no load.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from rr_opt.lab.rig import Rig

Array = NDArray[np.float64]


def loads(rig: Rig) -> Array:
    """With which each wheel presses on the floor, N (4,), in the order of WHEELS."""
    one, two = rig.robot.platform1, rig.robot.platform2
    stands = [(x, side * part.b) for x, part in ((one.c, one), (-two.c, two)) for side in (1, -1)]
    masses = [
        (one.m, one.joint_to_centre, rig.left[0]),
        (two.m, -two.joint_to_centre, rig.left[1]),
    ]
    if rig.load is not None:
        masses.append((rig.load[0], one.joint_to_centre, 0.0))
    balance = np.array([(1.0, x, y) for x, y in stands]).T
    weight = -rig.gravity[2] * np.array([(m, m * x, m * y) for m, x, y in masses]).sum(0)
    return np.linalg.lstsq(balance, weight)[0]
