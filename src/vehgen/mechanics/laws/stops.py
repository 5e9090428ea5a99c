"""Springs that join in beyond a travel: a second stage in bump, stops either way; a tyre that pushes but never pulls."""

from __future__ import annotations

from collections.abc import Mapping

import sympy as sp

from vehgen.mechanics.laws.base import Law, LawParameter, LawState, LawStep, positive


def _progressive_stiffness(motion: LawState, p: Mapping[str, sp.Expr]) -> LawStep:
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
        LawParameter("k", (1, -1, 0), "stiffness added beyond `start`", 0.0, 2.0e6, signed=True),
        LawParameter("start", (0, 1, 0), "travel in bump at which it joins in", 0.0, 0.05, signed=True),
    ),
    write=_progressive_stiffness,
)


def _bump_stop(motion: LawState, p: Mapping[str, sp.Expr]) -> LawStep:
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
        LawParameter("clearance", (0, 1, 0), "travel in bump before the stop is met", 0.005, 0.1, signed=True),
        LawParameter("rebound", (0, 1, 0), "travel in rebound before the stop is met (default: far away)", 0.005, 0.2, 1.0e3, signed=True),
    ),
    write=_bump_stop,
)


def _tyre_liftoff(motion: LawState, p: Mapping[str, sp.Expr]) -> LawStep:
    spring, beside = motion.static + motion.k * motion.d + motion.c * motion.v, motion.beside
    force, now = (p["share"] * positive(-(spring + other)) for other in (beside.force, beside.now))
    slope = None if beside.slope is None else p["share"] * (motion.k * motion.h / 2 + motion.c + beside.slope)
    return LawStep(force=force, now=now, slope=slope)


TYRE_LIFTOFF = Law(
    name="tyre_liftoff",
    title="Tyre that leaves the road",
    equation="f = share*max(-(static load + k*d + c*v + other laws of the tyre), 0), so that the whole contact force, "
    "but for dry friction, is never negative",
    meaning="over a sharp hump the wheel loses contact; the static load decides when",
    source="D. Cebon, Handbook of Vehicle-Road Interaction, 1999",
    strength="share",
    parameters=(LawParameter("share", (0, 0, 0), "1: the tyre cannot pull; 0: the linear tyre", 0.0, 1.0, 1.0, most=1.0),),
    write=_tyre_liftoff,
    attaches_to=("tyre",),
    limits_all=True,
)
