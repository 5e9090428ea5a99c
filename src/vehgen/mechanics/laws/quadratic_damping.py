"""Quadratic damping."""

from __future__ import annotations

from collections.abc import Mapping

import sympy as sp

from vehgen.mechanics.laws.base import Law, LawParameter, LawState, LawStep


def _write(motion: LawState, p: Mapping[str, sp.Expr]) -> LawStep:
    force = p["c2"] * motion.v * sp.Abs(motion.v)
    return LawStep(force=force, now=force)


QUADRATIC_DAMPING = Law(
    name="quadratic_damping",
    title="Quadratic damping",
    equation="f = c2*v*|v|",
    meaning="flow through a fixed orifice: the damper stiffens with speed",
    source="J. C. Dixon, The Shock Absorber Handbook, 2nd ed., 2007, doi:10.1002/9780470516430",
    strength="c2",
    parameters=(LawParameter("c2", (1, -2, 2), "quadratic damping", 0.0, 2.0e5),),
    write=_write,
)
