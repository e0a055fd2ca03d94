"""CasADi functions as machine code, where a C compiler is at hand."""

from __future__ import annotations

from collections.abc import Iterable

import casadi as ca

from rr_opt.physics.machine_code import library


def externals(
    name: str, functions: Iterable[ca.Function], flags: tuple[str, ...], *, make: bool
) -> tuple[ca.Function, ...] | None:
    """The same functions, if their code was compiled before, or is now; see `library`.

    name  of the code as a whole
    """
    generator = ca.CodeGenerator(name, {"with_header": False})
    functions = tuple(functions)
    for function in functions:
        generator.add(function)
    made = library(generator.dump(), flags, make=make)
    if made is None:
        return None
    return tuple(ca.external(function.name(), made._name) for function in functions)
