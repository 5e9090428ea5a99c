"""Forces that grow as a power of travel or rate: cubic and quadratic stiffness, quadratic damping."""

from __future__ import annotations

from collections.abc import Mapping

import sympy as sp

from vehgen.mechanics.laws.base import Law, LawParameter, LawState, LawStep


def _write_cubic_stiffness(motion: LawState, p: Mapping[str, sp.Expr]) -> LawStep:
    force = p["k3"] * motion.d**3
    return LawStep(force=force, now=force)


def _write_quadratic_stiffness(motion: LawState, p: Mapping[str, sp.Expr]) -> LawStep:
    force = p["k2"] * motion.d**2
    return LawStep(force=force, now=force)


def _write_quadratic_damping(motion: LawState, p: Mapping[str, sp.Expr]) -> LawStep:
    force = p["c2"] * motion.v * sp.Abs(motion.v)
    return LawStep(force=force, now=force)


CUBIC_STIFFNESS = Law(
    name="cubic_stiffness",
    title="Cubic stiffness",
    equation="f = k3*d^3",
    meaning="a spring that hardens (k3 > 0) alike in bump and rebound",
    source="I. Kovacic, M. J. Brennan, The Duffing Equation, 2011, doi:10.1002/9780470977859",
    strength="k3",
    parameters=(LawParameter("k3", (1, -3, 0), "cubic stiffness", 0.0, 5.0e9, signed=True),),
    write=_write_cubic_stiffness,
)
QUADRATIC_STIFFNESS = Law(
    name="quadratic_stiffness",
    title="Quadratic stiffness",
    equation="f = k2*d^2",
    meaning="a spring that hardens in bump and softens in rebound, such as an air spring about its ride height; for small travels only",
    source="J. C. Dixon, The Shock Absorber Handbook, 2nd ed., 2007, doi:10.1002/9780470516430",
    strength="k2",
    parameters=(LawParameter("k2", (1, -2, 0), "quadratic stiffness", 0.0, 5.0e7, signed=True),),
    write=_write_quadratic_stiffness,
)
QUADRATIC_DAMPING = Law(
    name="quadratic_damping",
    title="Quadratic damping",
    equation="f = c2*v*|v|",
    meaning="flow through a fixed orifice: the damper stiffens with speed",
    source="J. C. Dixon, The Shock Absorber Handbook, 2nd ed., 2007, doi:10.1002/9780470516430",
    strength="c2",
    parameters=(LawParameter("c2", (1, -2, 2), "quadratic damping", 0.0, 2.0e5),),
    write=_write_quadratic_damping,
)
