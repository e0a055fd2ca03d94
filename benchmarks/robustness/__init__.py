"""How the program stands what laboratories, users and machines do to it, counted."""
