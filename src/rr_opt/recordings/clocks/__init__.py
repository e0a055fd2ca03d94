"""The clocks of a capture system, of the command and of a servo's log."""
