"""Wheels creep and slide sideways as much as they are told to."""

import numpy as np
import pytest

from rr_lab.mujoco import drive
from rr_lab.mujoco.plant import Plant
from rr_lab.rig import Rig
from rr_lab.run import Conditions
from rr_opt.model.gait import SineGait
from tests.rr_lab.reduced import LONG

STEP = 5e-4
WEIGHT = 9.81 * (LONG.platform1.m + LONG.platform2.m)


def pushed(rig, force, seconds):
    """Sideways speeds (m/s) of the axles of a straight, locked robot pushed at its masses."""
    plant = Plant.of(rig, STEP)
    plant.put_down((0.0, 0.0, 0.0), 0.0)
    for _ in range(200):
        plant.mujoco.mj_step(plant.model, plant.data)
    at = plant.data.body("platform1").id, plant.data.body("platform2").id
    masses = np.array([LONG.platform1.m, LONG.platform2.m])
    for body, share in zip(at, masses / masses.sum(), strict=True):
        plant.data.xfrc_applied[body, 1] = force * share
    places = []
    for _ in range(round(seconds / STEP)):
        plant.mujoco.mj_step(plant.model, plant.data)
        places.append([plant.data.body(f"wheel{name}").xpos[1] for name in ("1L", "2L")])
    return plant, (np.array(places[-1]) - places[-2]) / STEP


def test_creep_is_speed_over_force():
    rig = Rig(LONG, creep=0.1)
    plant, wheels = pushed(rig, 0.4, 0.3)
    sideways = np.zeros(2)
    force = np.zeros(6)
    for n in range(plant.data.ncon):
        plant.mujoco.mj_contactForce(plant.model, plant.data, n, force)
        sideways[n // 2] += abs(force[1:3]).max() / 2
    # Each axle's wheels share its side force, and creep at 0.1 m/s for each newton.
    np.testing.assert_allclose(np.abs(wheels), 0.1 * sideways, rtol=0.02)
    assert sideways.sum() * 2 == pytest.approx(0.4, rel=0.02)


@pytest.mark.parametrize(("share", "slides"), [(0.9, False), (1.1, True)])
def test_slides_beyond_the_grip(share, slides):
    _, wheels = pushed(Rig(LONG, mu=0.1), share * 0.1 * WEIGHT, 0.2)
    assert (np.abs(wheels) > 1e-2).all() == slides
    assert slides or (np.abs(wheels) < 1e-4).all()


def test_sliding_wheels_carry_their_share_of_the_weight(monkeypatch):
    plants, loads, of = [], [], Plant.of
    monkeypatch.setattr(Plant, "of", lambda *given: plants.append(of(*given)) or plants[-1])

    def look(_):
        force, own = np.zeros(6), np.zeros(2)
        data = plants[0].data
        for n in range(data.ncon):
            plants[0].mujoco.mj_contactForce(plants[0].model, data, n, force)
            wheel = plants[0].model.geom(int(max(data.contact[n].geom))).name
            own[int("2" in wheel)] += force[0]
        loads.append(own)

    drive(Rig(LONG, mu=0.02, laws=[look]), SineGait(0.6, 1.2, 0.2), Conditions(3.0), STEP)
    one, two = LONG.platform1, LONG.platform2
    length = one.c + two.c
    on1 = 9.81 * (one.m * (length - one.a) + two.m * two.a) / length
    seen = np.array(loads)[len(loads) // 5 :] / [on1, WEIGHT - on1]
    assert np.abs(np.quantile(seen, [0.05, 0.95], axis=0) - 1).max() < 0.03
