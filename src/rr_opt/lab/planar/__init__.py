"""The second engine: two platforms in the plane, a motor, and four wheels on a floor that rubs.

Nothing is given and nothing is held: place, heading and the angle between the platforms all follow
from forces. No axle is kept from slipping, each wheel is, by its own contact.
"""
