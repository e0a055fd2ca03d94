"""How fast steady speeds of many gaits are computed, by this project and in other ways."""
