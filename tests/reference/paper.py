"""The paper's tables; the printed values are in the package, once, with table and errata."""

from rr_paper.publication import TABLE_1, TABLE_2, TABLE_3

__all__ = ["TABLE_1", "TABLE_2", "TABLE_3"]
