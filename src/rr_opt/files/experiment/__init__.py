"""The experiment file: a robot as it is believed to be, and which recordings were made of it."""
