"""Readers of recordings, a file each, and the registry of them."""
