"""The inverse of a small matrix of expressions, by cofactors: a third of the operations of QR."""

from __future__ import annotations

import casadi as ca


def inverted(A: ca.SX) -> ca.SX:
    """A^-1 of a regular matrix (n, n), for n up to 4 or so."""
    n = A.size1()
    if n == 1:
        return 1 / A
    cofactors = [
        [
            (-1) ** (i + j)
            * ca.det(A[[r for r in range(n) if r != j], [c for c in range(n) if c != i]])
            for j in range(n)
        ]
        for i in range(n)
    ]
    return ca.vertcat(*(ca.horzcat(*row) for row in cofactors)) / ca.det(A)
