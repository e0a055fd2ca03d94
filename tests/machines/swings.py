"""A pendulum by SciPy, as files of an experiment."""

import numpy as np
from scipy.integrate import solve_ivp

J, ML, B = 0.05, 0.1, 0.02
NOISE = 3e-3


def write(folder, dry, seed=0, runs=3, seconds=8.0):
    """Recordings with dry friction, the last held out; experiment.yaml believes in viscous."""
    rng, t = np.random.default_rng(seed), np.arange(0, seconds, 0.005)
    entries = []
    for k in range(runs):
        parts = [(rng.uniform(0.1, 0.25), rng.uniform(0.3, 1.2), rng.uniform(0, 6)) for _ in "abc"]

        def torque(at, parts=parts):
            return sum(a * np.sin(2 * np.pi * f * at + phase) for a, f, phase in parts)

        def rate(at, y, torque=torque):
            push = torque(at) - B * y[1] - dry * np.tanh(y[1] / 1e-2) - 9.81 * ML * np.sin(y[0])
            return [y[1], push / J]

        ran = solve_ivp(rate, (0, t[-1]), [0.3, 0.0], "LSODA", t, rtol=1e-7, atol=1e-9)
        angle = ran.y[0] + NOISE * rng.standard_normal(t.size)
        table = np.column_stack([t, np.degrees(angle), torque(t)])
        np.savetxt(folder / f"run{k}.csv", table, "%.9g", ",", header="time,angle,motor",
                   comments="")  # fmt: skip
        use = ", use: holdout" if k == runs - 1 else ""
        entries.append(f"  - {{file: run{k}.csv{use}}}")
    text = (
        f"machine: pendulum\nparameters: {{J: {J}, ml: {ML}, b: {B}}}\n"
        "uncertainty: {J: 5 %, ml: 1 %}\n"
        "columns: {t: time, q: {column: angle, factor: 1 deg}, u: motor}\nrecordings:\n"
    )
    (folder / "experiment.yaml").write_text(text + "\n".join(entries) + "\n")
    return folder
