"""The paper: its tables and figures again, its statements checked, its unknowns estimated."""
