"""Bouc-Wen hysteresis."""

from __future__ import annotations

from collections.abc import Mapping

import sympy as sp

from vehgen.mechanics.laws.base import Law, LawParameter, LawState, LawStep


def _write(motion: LawState, p: Mapping[str, sp.Expr]) -> LawStep:
    """Step z implicitly with |z| of mid-step lagged once: second order, no iteration.

    dz/dt = (v - (beta*|v|*|z| + (1 - beta)*v*z)*z)/travel is linear in z once the bracket is known.
    """
    start = motion.states["z"]
    gain = motion.h / p["travel"]
    middle = start
    end = start
    for _ in range(2):
        loss = gain * (p["beta"] * sp.Abs(motion.v) * sp.Abs(middle) + (1 - p["beta"]) * motion.v * middle) / 2
        end = (start * (1 - loss) + gain * motion.v) / (1 + loss)
        middle = (start + end) / 2
    return LawStep(force=p["force"] * middle, states={"z": end}, now=p["force"] * start, slope=p["force"] * gain)


HYSTERESIS = Law(
    name="hysteresis",
    title="Hysteresis (Bouc-Wen)",
    equation="f = force*z, travel*dz/dt = v - beta*|v|*|z|*z - (1 - beta)*v*z^2",
    meaning="rounded hysteresis loops of rubber and leaf springs, without a sharp stick",
    source="Y.-K. Wen, Method for random vibration of hysteretic systems, J. Eng. Mech. Div. 102(2), 1976, doi:10.1061/JMCEA3.0002106",
    strength="force",
    parameters=(
        LawParameter("force", (1, 0, 0), "force of the fully developed loop", 0.0, 2.0e4),
        LawParameter("travel", (0, 1, 0), "travel over which the loop develops", 5.0e-4, 0.02),
        LawParameter("beta", (0, 0, 0), "share of the loss that follows |v| (0.5: straight unloading)", 0.3, 1.0, 0.5),
    ),
    write=_write,
    states=("z",),
)
