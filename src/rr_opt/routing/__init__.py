"""From A to B: a path of straights and arcs, and the fastest drive along it, from rest to rest."""
