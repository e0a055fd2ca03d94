"""(a) The signs of equation (3)."""

from __future__ import annotations

from rr_opt.paper.equation3 import CORRECTED, PRINTED
from rr_opt.paper.reproduction import Reproduction
from rr_opt.report.paper.audit.section import Section
from rr_opt.report.quantities import number


def signs_section(found: Reproduction, mujoco: float | None) -> Section:
    """Which signs mechanics gives; mujoco: a speed as in `sections`."""
    audit = found.signs
    off = {one.signs.name: one for one in audit.off}
    energy = {one.signs.name: one for one in audit.energy}
    wrong, right = off[PRINTED.name], off[CORRECTED.name]
    printed, corrected = energy[PRINTED.name], energy[CORRECTED.name]
    driven = audit.driven
    gait = f"amplitude {number(driven.gait.amplitude)} rad, period {number(driven.gait.period)} s"
    seconds = number(float(driven.t[-1]))
    way = "makes" if printed.nowhere > 0 else "destroys"
    return Section(
        "signs",
        "Equation (3) is printed with wrong signs",
        "B1, B2 and D have the other sign, and epsilon inside B2 too. No way of counting v or phi "
        "mends it.",
        (
            f"Equation (3) was held against two derivations at {audit.states} states of random "
            "robots: Kane's method, done by CasADi from positions and velocities, and two "
            "separate bodies held together by Lagrange multipliers. They share no code, and agree "
            f"with each other on the servo's torque to {audit.torque:.0e}.",
            f"With corrected signs (3) agrees with both to {right.multipliers:.0e}. As printed its "
            f"median error is {number(100 * wrong.median, 3)} %. Counting v the other way turns "
            "B1, B2 and D together, but not epsilon; the median error is then "
            f"{number(100 * audit.off[1].median, 3)} %. Every term is even in phi, so counting phi "
            "the other way changes nothing.",
            f"From rest ({gait}, {seconds} s) Kane and the multipliers take P along the same path "
            f"to {driven.apart[0]:.0e} m, and the corrected (3) with (4) to {driven.apart[1]:.0e} "
            f"m. As printed, (3) with (4) ends {number(driven.apart[2], 3)} m off at most.",
            "Energy is a third witness. A robot that moves in a steady cycle as printed must be "
            f"pushed by a force, up to {number(printed.force, 3)} N, that nothing exerts. It "
            f"{way} {number(1e3 * abs(printed.nowhere), 3)} mW on average, while friction takes "
            f"{number(1e3 * printed.friction, 3)} mW. With corrected signs what the servo gives "
            f"is what friction takes, to {_rounded(corrected.gap / corrected.friction)} of it.",
            "The printed signs change the mean speed of this gait from "
            f"{number(1e3 * corrected.speed, 3)} to {number(1e3 * printed.speed, 3)} mm/s.",
            *_third(mujoco, corrected.speed),
        ),
        ("signs of (3)", "largest error against Kane", "against multipliers", "median error",
         "servo, mW", "friction, mW", "from nowhere, mW", "mean speed, m/s"),
        tuple(
            (
                name, one.kane, one.multipliers, one.median,
                *(
                    (1e3 * e.servo, 1e3 * e.friction, 1e3 * e.nowhere, e.speed)
                    if (e := energy.get(name))
                    else (None, None, None, None)
                ),
            )
            for name, one in off.items()
        ),
    )  # fmt: skip


def _third(mujoco: float | None, speed: float) -> tuple[str, ...]:
    if mujoco is None:
        return ()
    apart = 100 * abs(mujoco / speed - 1)
    return (
        "A three-dimensional model in MuJoCo, four wheels rolling on a floor, knows none of these "
        f"equations. It drives this gait at {number(1e3 * mujoco, 4)} mm/s, {number(apart, 1)} % "
        "from the corrected equation.",
    )


def _rounded(error: float) -> str:
    """An error that may be nothing at all."""
    return f"{max(abs(error), 1e-16):.0e}"
