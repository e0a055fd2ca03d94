"""Whatever the program is given, and whenever it is stopped: `make fuzz`, `make chaos`."""
