"""The public functions of the library; `import rr_opt as rr` has them all as `rr.NAME`."""
