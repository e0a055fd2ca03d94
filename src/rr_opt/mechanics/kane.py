"""Kane's equations of a mechanism, before constraints are applied.

With u = (v, s1, s2, dphi) the speeds of `kinematics`, every velocity and rate of the mechanism is
a function of phi and u, linear in u. A body of mass m whose centre moves at V, in the axes of a
platform that turns at w, accelerates by dV/dt + w x V; a rotor of inertia I turning at w by dw/dt.
Kane's equation for speed j equates the generalised inertia forces with those of forces F and servo:

    sum m (dV/dt + w x V) . dV/du_j + sum I dw/dt dw/du_j = sum F . dV/du_j + (0, F1, F2, torque)_j

Row v is the equation of motion, rows s1 and s2 give the constraint forces on the axles, and row
dphi gives the servo torque, which acts on platform 2 and reacts on platform 1. All partial
velocities and rates of change are CasADi's.
"""

from dataclasses import dataclass

import casadi as ca

from rr_opt.mechanics.kinematics import SPEEDS, Mechanism


@dataclass(frozen=True)
class Equations:
    """Kane's equations as expressions.

    needed   (4,) generalised force that each speed needs beyond the given forces, N, N, N, N m
    udot     (4,) symbols of the rates of change of the speeds
    kinetic  energy, J
    power    of the forces, W
    joint    velocity (2, m/s) of P in platform 1's axes
    rate     psi-dot, rad/s
    """

    needed: ca.SX
    udot: ca.SX
    kinetic: ca.SX
    power: ca.SX
    joint: ca.SX
    rate: ca.SX


def equations(robot: Mechanism) -> Equations:
    """Kane's equations of a mechanism, with all its bodies and forces."""
    phi, u = robot.phi, robot.speeds
    udot = ca.vertcat(*(ca.SX.sym(f"{name}dot") for name in SPEEDS))

    def change(quantity: ca.SX) -> ca.SX:
        return ca.jtimes(quantity, phi, u[SPEEDS.index("dphi")]) + ca.jtimes(quantity, u, udot)

    needed = ca.SX.zeros(len(SPEEDS))
    kinetic, power = ca.SX(0), ca.SX(0)
    for body in robot.bodies:
        frame = robot.frames[body.platform]
        V = frame.velocity(body.point)
        acceleration = change(V) + frame.rate * ca.vertcat(-V[1], V[0])
        needed += ca.jtimes(V, u, body.mass * acceleration, True)
        kinetic += body.mass * ca.sumsqr(V) / 2
    for rotor in robot.rotors:
        needed += ca.jtimes(rotor.rate, u, rotor.inertia * change(rotor.rate), True)
        kinetic += rotor.inertia * rotor.rate**2 / 2
    for force in robot.forces:
        V = robot.frames[force.platform].velocity(force.point)
        needed -= ca.jtimes(V, u, force.vector, True)
        power += ca.dot(V, force.vector)
    frame = robot.frames[1]
    return Equations(needed, udot, kinetic, power, frame.velocity(robot.joint(1)), frame.rate)
