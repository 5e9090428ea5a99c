"""Dry friction that truly sticks: set-valued Coulomb friction."""

from __future__ import annotations

from collections.abc import Mapping

import sympy as sp

from vehgen.mechanics.laws.base import Law, LawParameter, LawState, LawStep


def _write(motion: LawState, p: Mapping[str, sp.Expr]) -> LawStep:
    return LawStep(friction=p["force"], slope=sp.S.Zero)


DRY_FRICTION = Law(
    name="dry_friction",
    title="Dry friction (Coulomb)",
    equation="f = force*sign(v) while slipping; any |f| <= force that holds v = 0 while sticking",
    meaning="friction between leaves, in bushes or in a fifth wheel: it locks the joint until the load exceeds the force",
    source="J. J. Moreau, Unilateral contact and dry friction in finite freedom dynamics, 1988, doi:10.1007/978-3-7091-2624-0_1",
    strength="force",
    parameters=(LawParameter("force", (1, 0, 0), "force (on a hinge: moment) at which it slips", 0.0, 2.0e4),),
    write=_write,
)
