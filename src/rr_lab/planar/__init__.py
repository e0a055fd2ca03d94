"""The second engine: two platforms in the plane, a motor, and four wheels on a floor that rubs."""
