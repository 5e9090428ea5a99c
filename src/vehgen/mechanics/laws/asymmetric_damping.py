"""Asymmetric damper: different in bump and rebound, with a blow-off."""

from __future__ import annotations

from collections.abc import Mapping

import sympy as sp

from vehgen.mechanics.laws.base import Law, LawParameter, LawState, LawStep, positive


def _write(motion: LawState, p: Mapping[str, sp.Expr]) -> LawStep:
    bump, rebound = positive(motion.v), positive(-motion.v)
    bump_beyond, rebound_beyond = positive(bump - p["blow_off"]), positive(rebound - p["blow_off"])
    force = p["c"] * (p["ratio"] * bump - rebound - p["relief"] * (p["ratio"] * bump_beyond - rebound_beyond))
    return LawStep(force=force, now=force, slope=p["c"] * sp.Max(p["ratio"], 1))


ASYMMETRIC_DAMPING = Law(
    name="asymmetric_damping",
    title="Asymmetric damper",
    equation="f = c*ratio*b(v) in bump, -c*b(-v) in rebound, b(u) = u - relief*max(u - blow_off, 0)",
    meaning="a telescopic damper: weaker in bump (ratio < 1) than in rebound; beyond the blow-off rate its valves open",
    source="J. C. Dixon, The Shock Absorber Handbook, 2nd ed., 2007, doi:10.1002/9780470516430",
    strength="c",
    parameters=(
        LawParameter("c", (1, -1, 1), "damping in rebound", 0.0, 5.0e4),
        LawParameter("ratio", (0, 0, 0), "damping in bump over that in rebound", 0.1, 1.0),
        LawParameter("blow_off", (0, 1, -1), "rate at which the valves open (default: never)", 0.05, 10.0, 1.0e3),
        LawParameter("relief", (0, 0, 0), "share of the damping lost beyond blow_off (0: no blow-off)", 0.0, 0.9, 0.0, most=1.0),
    ),
    write=_write,
)
