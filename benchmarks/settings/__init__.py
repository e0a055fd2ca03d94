"""How the diagnosis depends on each number that was chosen."""
