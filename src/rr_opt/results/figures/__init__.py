"""The figures of results, as SVG text; everything that imports matplotlib."""
