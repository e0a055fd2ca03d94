"""A servo that is off by a constant makes the command and that constant, at the same rates."""

import numpy as np

from rr_opt.effects import CATALOGUE
from rr_opt.mechanics.drive import commanded
from rr_opt.model.gait import SineGait

GAIT = SineGait(0.6, 0.8, 0.1)


def test_constant():
    t = np.linspace(-0.5, 2.0, 51)
    for rest in (True, False):
        command = commanded(GAIT, rest)
        made = CATALOGUE["servo_offset"].actuate(command, {"offset": 0.03}).at(t)
        np.testing.assert_allclose(made - command.at(t), np.outer([0.03, 0, 0], np.ones(51)))
