"""Six parameters of a Roller Racer fitted to six recordings, by this project and by others."""
