"""A damper with free play: it acts only while its worn eyes are pressed together the way it moves."""

from __future__ import annotations

from collections.abc import Mapping

import sympy as sp

from vehgen.mechanics.laws.base import Law, LawParameter, LawState, LawStep, positive


def _write(motion: LawState, p: Mapping[str, sp.Expr]) -> LawStep:
    """Let the damper stand until the travel at the end of the step carries it along by one end of its play."""
    start, half = motion.states["y"], p["play"] / 2
    travel = motion.d + motion.h * motion.v / 2
    end = sp.Min(sp.Max(start, travel - half), travel + half)
    return LawStep(
        force=p["c"] * (end - start) / motion.h,
        states={"y": end},
        now=p["c"] * (_rate(motion.v, motion.d - start - half, motion.h) - _rate(-motion.v, start - motion.d - half, motion.h)),
        slope=p["c"],
    )


def _rate(rate: sp.Expr, beyond: sp.Expr, h: sp.Expr) -> sp.Expr:
    """Return the damper's rate where the travel is `beyond` the end of the play, below 0 within it: 0, or the spring's.

    Within a step of the end it rises from one to the other: else readings would jump as an end is met one step sooner.
    """
    return sp.Min(positive(rate + beyond / h), positive(rate))


DAMPER_FREE_PLAY = Law(
    name="damper_free_play",
    title="Damper with free play",
    equation="f = c*dy/dt, y carried along by d where |d - y| would be more than play/2",
    meaning="a damper in worn eyes or bushes: it stands still until its play is closed, in whose middle a run begins",
    source="M. Brokate, J. Sprekels, Hysteresis and Phase Transitions, 1996, doi:10.1007/978-1-4612-4048-8 (the play operator)",
    strength="c",
    parameters=(
        LawParameter("c", (1, -1, 1), "damping once the play is closed", 0.0, 5.0e4),
        LawParameter("play", (0, 1, 0), "from one end of the play to the other", 0.0, 0.02),
    ),
    write=_write,
    states=("y",),
)
