"""Elasto-plastic friction: a spring in series with a dry friction slider (Jenkins element)."""

from __future__ import annotations

from collections.abc import Mapping

import sympy as sp

from vehgen.mechanics.laws.base import Law, LawParameter, LawState, LawStep


def _write(motion: LawState, p: Mapping[str, sp.Expr]) -> LawStep:
    start = motion.states["s"]
    end = sp.Min(sp.Max(start + p["k"] * motion.h * motion.v, -p["force"]), p["force"])
    slope = p["k"] * motion.h / 2 * sp.Heaviside(p["force"])
    return LawStep(force=(start + end) / 2, states={"s": end}, now=start, slope=slope)


ELASTO_PLASTIC = Law(
    name="elasto_plastic",
    title="Elasto-plastic friction (Jenkins)",
    equation="df/dt = k*v within |f| <= force; f stays at +-force while it slips",
    meaning="leaf springs and bushes: stiff for small motions, sliding for large ones",
    source="W. D. Iwan, A distributed-element model for hysteresis, J. Appl. Mech. 33(4), 1966, doi:10.1115/1.3625199",
    strength="force",
    parameters=(
        LawParameter("force", (1, 0, 0), "force at which it slips", 0.0, 2.0e4),
        LawParameter("k", (1, -1, 0), "stiffness while it sticks", 1.0e5, 5.0e7),
    ),
    write=_write,
    states=("s",),
)
