"""Dry friction that truly sticks, and slips in compression at another force than in extension."""

from __future__ import annotations

from collections.abc import Mapping

import sympy as sp

from vehgen.mechanics.laws.base import Law, LawParameter, LawState, LawStep


def _write(motion: LawState, p: Mapping[str, sp.Expr]) -> LawStep:
    middle = p["force"] * (p["ratio"] - 1) / (p["ratio"] + 1)
    return LawStep(friction=p["force"], friction_middle=middle, slope=sp.S.Zero)


ASYMMETRIC_FRICTION = Law(
    name="asymmetric_friction",
    title="Asymmetric dry friction (Coulomb)",
    equation=(
        "f = 2*force*ratio/(1 + ratio) while it slips in compression, -2*force/(1 + ratio) in extension; any f between them holds v = 0"
    ),
    meaning="friction that is stronger one way, as of lip seals: dry friction beside a constant force, but one that pushes nothing at rest",
    source="J. J. Moreau, Unilateral contact and dry friction in finite freedom dynamics, 1988, doi:10.1007/978-3-7091-2624-0_1",
    strength="force",
    parameters=(
        LawParameter("force", (1, 0, 0), "mean of the forces (on a hinge: moments) at which it slips one way and the other", 0.0, 2.0e4),
        LawParameter("ratio", (0, 0, 0), "force in compression over that in extension", 0.1, 10.0),
    ),
    write=_write,
)
