"""How long a diagnosis takes, and where the time goes."""
