"""How long marker files take to read, fit and clean."""
