"""A free-form law fitted to a recovered force: force = f(travel) + g(rate), whatever their shapes. A description, not a physical law.

f and g are piecewise linear between knots that lie closer near rest, each a straight line and a rest with penalised second differences
(P. H. C. Eilers, B. D. Marx, Statistical Science 11 (1996) 89, doi:10.1214/ss/1038425655). Both are zero at rest: the constant lies below
the band, and force laws count from static equilibrium. Intervals are those of a bootstrap that draws stretches of time (H. R. Künsch,
Annals of Statistics 17 (1989) 1217, doi:10.1214/aos/1176347265), with the base fit drawn along. The sign is that of force laws: travel
and force are positive in compression, so that a positive force resists a positive travel.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vehgen.diagnose.recovered import Recovered, recover, strongest
from vehgen.diagnose.smoothing import (
    KNOTS,
    SIDE,
    Basis,
    bootstrap,
    curves_basis,
    explained_share,
    left_over,
    normal_equations,
    place_knots,
    shifts,
    smooth,
    surface_basis,
)

Array = NDArray[np.float64]
MOVING = 0.02
"""A place moves while its travel or rate exceeds this share of the largest."""
ROUNDS = 8
"""How often the weights, and the motion's answer to what the band hides of the force, are found anew."""
RELAX = 0.5
POINTS = 61
"""Points of a curve."""
DRAWS = 400
POOR = 0.7
"""A law that explains less than this is called poor."""
SIGN = "travel and force are positive in compression: a positive force resists a positive travel"
MATTERS = 0.1
"""A curve with less than this share of the other one's force goes without saying."""


@dataclass(frozen=True, eq=False)
class Curve:
    """One curve of a free-form law over the middle 98 % of the motion.

    `x shape (n,)` travel or rate, `force shape (n,)` and its pointwise 90 % interval `low`, `high`; `share` is the mean square of its
    force, as the band shows it, over that of the recovered force.
    """

    x: Array
    force: Array
    low: Array
    high: Array
    share: float

    def to_dict(self) -> dict[str, list[float]]:
        """Return plain data for JSON."""
        return {name: [float(f"{value:.6g}") for value in getattr(self, name)] for name in ("x", "force", "low", "high")}


@dataclass(frozen=True, eq=False)
class FreeForm:
    """A free-form law.

    Attributes
    ----------
    place, units
        Where it acts; units of travel, rate and force.
    travel, rate
        f and g. They add to the base model's own `stiffness` and `damping` there, from which no recording can tell their straight parts.
    explained
        Share of the recovered force's variance beyond its noise, within the band, that f + g explain on the untouched runs.
    beyond
        Share that they explain of what no straight spring and damper explain; unlike `explained` it does not hang on the base fit's own.
    coupled
        The further share of it that a surface over travel and rate together explains.
    hysteresis
        The share of it that no function of travel and rate explains: memory, or another cause.
    runs
        The runs as recovered, with what the band hides of the force in their motion.
    histories
        f + g by run, filtered as the recovered force is.
    """

    place: str
    units: tuple[str, str, str]
    travel: Curve
    rate: Curve
    stiffness: float
    damping: float
    explained: float
    beyond: float
    coupled: float
    hysteresis: float
    runs: tuple[Recovered, ...]
    histories: dict[str, Array]

    def describe(self) -> str:
        """Return what the law says, in a sentence."""
        angular = self.units[0] == "rad"
        least = MATTERS * max(self.travel.share, self.rate.share)
        parts = []
        if self.travel.share >= least:
            parts.append(_stretch(self.travel, 1.0 if angular else 1e3, "rad" if angular else "mm of travel", self.units[2]))
        if self.rate.share >= least:
            parts.append(_stretch(self.rate, 1.0, self.units[1], self.units[2]))
        poor = "only " if self.explained < POOR else ""
        memory = (
            f", {_percent(self.hysteresis)} of what is not straight is no matter of travel and rate" if self.hysteresis > 1 - POOR else ""
        )
        return (
            f"{' and '.join(parts)}; it explains {poor}{_percent(self.explained)} of the unknown force at {self.place} on untouched runs"
            f"{memory} (a description, not a physical law)"
        )

    def to_dict(self) -> dict[str, Any]:
        """Return plain data for JSON."""
        return {
            "place": self.place,
            "sign": SIGN,
            "units": dict(zip(("travel", "rate", "force"), self.units, strict=True)),
            "base_stiffness": self.stiffness,
            "base_damping": self.damping,
            "explained": self.explained,
            "beyond_spring_and_damper": self.beyond,
            "coupled": self.coupled,
            "hysteresis": self.hysteresis,
            "description": self.describe(),
            "travel": self.travel.to_dict(),
            "rate": self.rate.to_dict(),
        }


def fit_free_form(recovered: Sequence[Recovered], seed: int = 11) -> FreeForm | None:
    """Fit a free-form law to the force recovered in the training runs, and judge it on the untouched ones.

    Parameters
    ----------
    recovered
        The force in every run, of :func:`recover`.
    seed
        Of the bootstrap.

    Returns
    -------
    None where nothing was recovered (a place without a force), or where the place does not move.
    """
    runs = list(recovered)
    training = [run for run in runs if not run.untouched]
    reach = [np.concatenate([getattr(run, name) for run in training] or [np.zeros(1)]) for name in ("travel", "rate")]
    moving = np.any([np.abs(x) > MOVING * np.abs(x).max() for x in reach], axis=0)
    if not moving.any():
        return None
    basis, penalties = curves_basis(*(place_knots(x[moving], KNOTS) for x in reach))
    excess = left_over(training, [np.zeros(len(run.time)) for run in training])
    for _ in range(ROUNDS):
        training = [run for run in runs if not run.untouched]
        parts = [normal_equations(run, run.force, _columns(run, basis), excess) for run in training]
        found = smooth(parts, penalties)
        histories = [_columns(run, basis) @ found.coefficients for run in runs]
        excess = left_over(training, [_columns(run, basis) @ found.coefficients for run in training])
        hidden = [run.unseen_motion(history) for run, history in zip(recovered, histories, strict=True)]
        runs = [_relaxed(run, first, *extra) for run, first, extra in zip(runs, recovered, hidden, strict=True)]
    random = np.random.Generator(np.random.PCG64(seed))
    draws = bootstrap(parts, found, DRAWS, random)
    moved = shifts(training, basis, excess, found)
    draws += random.standard_normal((DRAWS, len(moved))) @ moved
    surface, bends = surface_basis(*(place_knots(x[moving], SIDE) for x in reach))
    whole = smooth([normal_equations(run, run.force, _columns(run, surface), excess) for run in training], bends)
    straight = smooth([normal_equations(run, run.force, _straight(run), excess) for run in training], [np.zeros((2, 2))])
    judged = [run for run in runs if run.untouched] or training
    law, bent, line = (
        explained_share(judged, [columns(run) @ fit.coefficients for run in judged])
        for fit, columns in (
            (found, lambda run: _columns(run, basis)),
            (whole, lambda run: _columns(run, surface)),
            (straight, _straight),
        )
    )
    left = max(1.0 - line, 1e-12)
    beyond, together = ((share - line) / left for share in (law, bent))
    first = recovered[0]
    return FreeForm(
        first.place.label,
        first.units,
        _curve(0, reach[0][moving], basis, found.coefficients, draws, runs),
        _curve(1, reach[1][moving], basis, found.coefficients, draws, runs),
        first.stiffness,
        first.damping,
        law,
        beyond,
        max(together - beyond, 0.0),
        min(1.0 - max(beyond, together), 1.0),
        tuple(runs),
        {run.run: run.seen(_columns(run, basis) @ found.coefficients) for run in runs},
    )


def _columns(run: Recovered, basis: Basis) -> Array:
    return basis(run.travel, run.rate)


def _straight(run: Recovered) -> Array:
    return np.column_stack([run.travel, run.rate])


def _relaxed(run: Recovered, first: Recovered, travel: Array, rate: Array) -> Recovered:
    """Return a run a share of the way to the motion with what the band hides: a whole step may overshoot where a law is stiff."""
    return replace(
        run,
        travel=run.travel + RELAX * (first.travel + travel - run.travel),
        rate=run.rate + RELAX * (first.rate + rate - run.rate),
    )


def _curve(axis: int, reach: Array, basis: Basis, coefficients: Array, draws: Array, runs: Sequence[Recovered]) -> Curve:
    """Return f (axis 0) or g (axis 1)."""

    def alone(x: Array) -> Array:
        return basis(np.zeros_like(x), x) if axis else basis(x, np.zeros_like(x))

    x = np.linspace(float(np.percentile(reach, 1)), float(np.percentile(reach, 99)), POINTS)
    columns = alone(x)
    low, high = np.percentile(draws @ columns.T, [5, 95], axis=0)
    own = sum(float((run.seen(alone(run.rate if axis else run.travel) @ coefficients) ** 2).sum()) for run in runs)
    return Curve(x, columns @ coefficients, low, high, own / sum(float((run.force**2).sum()) for run in runs))


def _stretch(curve: Curve, scale: float, unit: str, force: str) -> str:
    steps = np.diff(curve.force)
    verb = "grows" if (steps >= 0).all() else "falls" if (steps <= 0).all() else "goes"
    low, high = scale * curve.x[0], scale * curve.x[-1]
    return f"between {low:.3g} and {high:.3g} {unit} the force {verb} from {curve.force[0]:.3g} to {curve.force[-1]:.3g} {force}"


def _percent(share: float) -> str:
    return f"{100 * max(share, 0.0):.0f} %"


__all__ = ["Curve", "FreeForm", "Recovered", "fit_free_form", "recover", "strongest"]
