"""Choosing the gait: seeds from a scan, then multiple shooting."""
