"""Dry friction: set-valued (Coulomb), alike both ways or not, and behind a spring (Jenkins)."""

from __future__ import annotations

from collections.abc import Mapping

import sympy as sp

from vehgen.mechanics.laws.base import Law, LawParameter, LawState, LawStep


def _dry_friction(motion: LawState, p: Mapping[str, sp.Expr]) -> LawStep:
    return LawStep(friction=p["force"], slope=sp.S.Zero)


DRY_FRICTION = Law(
    name="dry_friction",
    title="Dry friction (Coulomb)",
    equation="f = force*sign(v) while slipping; any |f| <= force that holds v = 0 while sticking",
    meaning="friction between leaves, in bushes or in a fifth wheel: it locks the joint until the load exceeds the force",
    source="J. J. Moreau, Unilateral contact and dry friction in finite freedom dynamics, 1988, doi:10.1007/978-3-7091-2624-0_1",
    strength="force",
    parameters=(LawParameter("force", (1, 0, 0), "force (on a hinge: moment) at which it slips", 0.0, 2.0e4),),
    write=_dry_friction,
)


def _asymmetric_friction(motion: LawState, p: Mapping[str, sp.Expr]) -> LawStep:
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
    write=_asymmetric_friction,
)


def _elasto_plastic(motion: LawState, p: Mapping[str, sp.Expr]) -> LawStep:
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
    write=_elasto_plastic,
    states=("s",),
)
