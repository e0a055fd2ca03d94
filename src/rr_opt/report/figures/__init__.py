"""Figures: functions that take axes and data and return the axes. matplotlib is used only here."""
