"""The second engine: two planar bodies, a motor, and four wheels with friction on a floor."""
