"""A user's own law: an expression of d and v in the vehicle file."""

from __future__ import annotations

from collections.abc import Mapping

import sympy as sp

from vehgen.mechanics.laws.base import Law, LawState, LawStep


def custom_law(force: sp.Expr, own: Mapping[str, sp.Expr]) -> Law:
    """Return a law whose force is an expression of the symbols d [m], v [m/s] and its own parameters (given as symbols in `own`)."""

    def write(motion: LawState, p: Mapping[str, sp.Expr]) -> LawStep:
        values = {sp.Symbol("d", real=True): motion.d, sp.Symbol("v", real=True): motion.v}
        values |= {sp.Symbol(name, real=True): value for name, value in own.items()}
        found = force.subs(values, simultaneous=True)
        return LawStep(force=found, now=found)

    return Law("law", "Own law", str(force), "an expression in the vehicle file", "", "", (), write)
