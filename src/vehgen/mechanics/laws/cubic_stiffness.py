"""Cubic stiffness."""

from __future__ import annotations

from collections.abc import Mapping

import sympy as sp

from vehgen.mechanics.laws.base import Law, LawParameter, LawState, LawStep


def _write(motion: LawState, p: Mapping[str, sp.Expr]) -> LawStep:
    force = p["k3"] * motion.d**3
    return LawStep(force=force, now=force)


CUBIC_STIFFNESS = Law(
    name="cubic_stiffness",
    title="Cubic stiffness",
    equation="f = k3*d^3",
    meaning="a spring that hardens (k3 > 0) alike in bump and rebound",
    source="I. Kovacic, M. J. Brennan, The Duffing Equation, 2011, doi:10.1002/9780470977859",
    strength="k3",
    parameters=(LawParameter("k3", (1, -3, 0), "cubic stiffness", 0.0, 5.0e9),),
    write=_write,
)
