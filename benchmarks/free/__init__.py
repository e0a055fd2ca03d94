"""Free gaits: whether a climb by another method, on another model, goes on from the answer."""
