"""The paper: its tables and figures recomputed, its statements checked, its unknowns estimated."""
