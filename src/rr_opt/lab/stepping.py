"""Many steps of a plant at once.

MuJoCo takes them by itself, from a table of controls. Only where something acts on the robot that
it cannot be told beforehand, a law of the wheels or a push, is each step taken from here.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from rr_opt.lab.plant import Plant

Array = NDArray[np.float64]


def stepped(plant: Plant, controls: Array, times: Array) -> Array:
    """Take a step with each control; what the sensors see at the beginning of each, (n, sensors).

    controls  angular accelerations of the flywheel, rad/s2 (n,)
    times     since the robot was let go, s (n,), for the laws

    Raises NotConvergedError if MuJoCo lost the motion.
    """
    # MuJoCo's own loop forgets forces.
    alone = plant.rig.laws or plant.data.xfrc_applied.any()
    seen = _one_by_one(plant, controls, times) if alone else _all(plant, controls)
    # Asked here and not at the end of a run: that loop begins by forgetting earlier warnings.
    plant.require_sound()
    return seen


def _one_by_one(plant: Plant, controls: Array, times: Array) -> Array:
    model, data, laws = plant.model, plant.data, plant.rig.laws
    step, control, sensors = plant.mujoco.mj_step, data.ctrl, data.sensordata
    seen = np.empty((len(controls), model.nsensordata))
    for k, (given, t) in enumerate(zip(controls.tolist(), times.tolist(), strict=True)):
        if laws:
            plant.brake(t)
        control[0] = given
        step(model, data)
        seen[k] = sensors
    return seen


def _all(plant: Plant, controls: Array) -> Array:
    mujoco, model, data = plant.mujoco, plant.model, plant.data
    kind = mujoco.mjtState.mjSTATE_FULLPHYSICS.value
    state = np.empty(mujoco.mj_stateSize(model, kind))
    mujoco.mj_getState(model, data, state, kind)
    # The solver starts from the last step's answer.
    warm = data.qacc_warmstart.copy()
    _, seen = mujoco.rollout.rollout(model, data, state, controls[:, None], initial_warmstart=warm)
    return seen[0]
