"""Maxwell branch: a spring in series with a dashpot."""

from __future__ import annotations

from collections.abc import Mapping

import sympy as sp

from vehgen.mechanics.laws.base import Law, LawParameter, LawState, LawStep


def _write(motion: LawState, p: Mapping[str, sp.Expr]) -> LawStep:
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
        LawParameter("time", (0, 0, 1), "relaxation time, dashpot over spring", 1.0e-3, 2.0),
    ),
    write=_write,
    states=("s",),
)
