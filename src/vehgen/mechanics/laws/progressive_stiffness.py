"""Progressive (piecewise-linear) stiffness."""

from __future__ import annotations

from collections.abc import Mapping

import sympy as sp

from vehgen.mechanics.laws.base import Law, LawParameter, LawState, LawStep, positive


def _write(motion: LawState, p: Mapping[str, sp.Expr]) -> LawStep:
    force = p["k"] * positive(motion.d - p["start"])
    return LawStep(force=force, now=force, slope=p["k"] * motion.h / 2)


PROGRESSIVE_STIFFNESS = Law(
    name="progressive_stiffness",
    title="Progressive stiffness",
    equation="f = k*max(d - start, 0)",
    meaning="a helper leaf, a second spring stage or a stop that joins in beyond a travel in bump, and nothing in rebound",
    source="T. D. Gillespie, Fundamentals of Vehicle Dynamics, SAE, 1992, doi:10.4271/R-114",
    strength="k",
    parameters=(
        LawParameter("k", (1, -1, 0), "stiffness added beyond `start`", 0.0, 2.0e6),
        LawParameter("start", (0, 1, 0), "travel in bump at which it joins in", 0.0, 0.05),
    ),
    write=_write,
)
