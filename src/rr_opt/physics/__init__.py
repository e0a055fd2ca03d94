"""The equations of motion, derived by CasADi from positions and velocities.

Physics beyond the paper's model enters at one of five ports (`effects.Port`):

actuation    command -> angle: between the gait and the phi(t) the mechanics is driven with
constraint   which side speeds of the axles are held at zero, and which way the axles point
force        forces at points of the mechanism
mass         bodies: masses, inertias, centres
measurement  between the motion and what is recorded of it
"""
