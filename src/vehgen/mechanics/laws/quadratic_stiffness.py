"""Quadratic stiffness."""

from __future__ import annotations

from collections.abc import Mapping

import sympy as sp

from vehgen.mechanics.laws.base import Law, LawParameter, LawState, LawStep


def _write(motion: LawState, p: Mapping[str, sp.Expr]) -> LawStep:
    force = p["k2"] * motion.d**2
    return LawStep(force=force, now=force)


QUADRATIC_STIFFNESS = Law(
    name="quadratic_stiffness",
    title="Quadratic stiffness",
    equation="f = k2*d^2",
    meaning="a spring that hardens in bump and softens in rebound, such as an air spring about its ride height; for small travels only",
    source="J. C. Dixon, The Shock Absorber Handbook, 2nd ed., 2007, doi:10.1002/9780470516430",
    strength="k2",
    parameters=(LawParameter("k2", (1, -2, 0), "quadratic stiffness", 0.0, 5.0e7),),
    write=_write,
)
