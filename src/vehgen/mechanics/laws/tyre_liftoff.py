"""A tyre that leaves the road: it pushes but never pulls."""

from __future__ import annotations

from collections.abc import Mapping

import sympy as sp

from vehgen.mechanics.laws.base import Law, LawParameter, LawState, LawStep, positive


def _write(motion: LawState, p: Mapping[str, sp.Expr]) -> LawStep:
    force = p["share"] * positive(-(motion.static + motion.k * motion.d + motion.c * motion.v))
    return LawStep(force=force, now=force, slope=p["share"] * (motion.k * motion.h / 2 + motion.c))


TYRE_LIFTOFF = Law(
    name="tyre_liftoff",
    title="Tyre that leaves the road",
    equation="f = share*max(-(static load + k*d + c*v), 0), so that the whole contact force is never negative",
    meaning="over a sharp hump the wheel loses contact; the static load decides when",
    source="D. Cebon, Handbook of Vehicle-Road Interaction, 1999",
    strength="share",
    parameters=(LawParameter("share", (0, 0, 0), "1: the tyre cannot pull; 0: the linear tyre", 0.0, 1.0, 1.0),),
    write=_write,
    attaches_to=("tyre",),
)
