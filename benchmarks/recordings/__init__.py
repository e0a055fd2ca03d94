"""How many optimisations a study does in an hour, and what a case costs beside its solve."""
