"""Independent checks of an optimum: a dense sweep, and a replay of the winner."""
