"""Bump and rebound stops with clearance."""

from __future__ import annotations

from collections.abc import Mapping

import sympy as sp

from vehgen.mechanics.laws.base import Law, LawParameter, LawState, LawStep, positive


def _write(motion: LawState, p: Mapping[str, sp.Expr]) -> LawStep:
    force = p["k"] * (positive(motion.d - p["clearance"]) - positive(-motion.d - p["rebound"]))
    return LawStep(force=force, now=force, slope=p["k"] * motion.h / 2)


BUMP_STOP = Law(
    name="bump_stop",
    title="Bump and rebound stops",
    equation="f = k*(max(d - clearance, 0) - max(-d - rebound, 0))",
    meaning="stops that a suspension meets beyond its clearance from static ride height (or from where `from` says)",
    source="J. Reimpell, H. Stoll, J. W. Betzler, The Automotive Chassis, 2nd ed., 2001",
    strength="k",
    parameters=(
        LawParameter("k", (1, -1, 0), "stiffness of the stops", 0.0, 1.0e7),
        LawParameter("clearance", (0, 1, 0), "travel in bump before the stop is met", 0.005, 0.1),
        LawParameter("rebound", (0, 1, 0), "travel in rebound before the stop is met (default: far away)", 0.005, 0.2, 1.0e3),
    ),
    write=_write,
)
