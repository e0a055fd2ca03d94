"""Checking an optimum another way: a dense sweep, and a replay of the winner."""
