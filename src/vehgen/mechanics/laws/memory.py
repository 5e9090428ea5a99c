"""Laws that remember: hysteresis (Bouc-Wen) and relaxation (Maxwell branch)."""

from __future__ import annotations

from collections.abc import Mapping

import sympy as sp

from vehgen.mechanics.laws.base import Law, LawParameter, LawState, LawStep


def _hysteresis(motion: LawState, p: Mapping[str, sp.Expr]) -> LawStep:
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
        LawParameter("travel", (0, 1, 0), "travel over which the loop develops", 5.0e-4, 0.02, above_zero=True),
        LawParameter("beta", (0, 0, 0), "share of the loss that follows |v| (0.5: straight unloading)", 0.3, 1.0, 0.5),
    ),
    write=_hysteresis,
    states=("z",),
)


def _relaxation(motion: LawState, p: Mapping[str, sp.Expr]) -> LawStep:
    start = motion.states["s"]
    half = motion.h / (2 * p["time"])
    end = (start * (1 - half) + p["k"] * motion.h * motion.v) / (1 + half)
    return LawStep(force=(start + end) / 2, states={"s": end}, now=start, slope=p["k"] * motion.h / 2)


RELAXATION = Law(
    name="relaxation",
    title="Relaxation (Maxwell branch)",
    equation="df/dt = k*v - f/time",
    meaning="rubber mounts and dampers with soft tops: stiff against fast motions, yielding to slow ones",
    source="W. N. Findley, J. S. Lai, K. Onaran, Creep and Relaxation of Nonlinear Viscoelastic Materials, 1976",
    strength="k",
    parameters=(
        LawParameter("k", (1, -1, 0), "stiffness of the series spring", 0.0, 5.0e6),
        LawParameter("time", (0, 0, 1), "relaxation time, dashpot over spring", 1.0e-3, 2.0, above_zero=True),
    ),
    write=_relaxation,
    states=("s",),
)
