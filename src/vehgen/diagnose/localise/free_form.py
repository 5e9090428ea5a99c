"""A free-form law fitted to a recovered force: force = f(travel) + g(rate), whatever their shapes. A description, not a physical law.

f and g are piecewise linear between knots that lie closer near rest, each a straight line and a rest with penalised second differences
(P. H. C. Eilers, B. D. Marx, Statistical Science 11 (1996) 89, doi:10.1214/ss/1038425655). Both are zero at rest: the constant lies below
the band, and force laws count from static equilibrium. Intervals are those of a bootstrap that draws stretches of time (H. R. Künsch,
Annals of Statistics 17 (1989) 1217, doi:10.1214/aos/1176347265), with the base fit drawn along. The sign is that of force laws: travel
and force are positive in compression, so that a positive force resists a positive travel.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vehgen.diagnose.localise.recovered_force import RecoveredForce, recover, strongest
from vehgen.diagnose.localise.smoothing import (
    N_KNOTS,
    FittedLaw,
    bootstrap,
    coupled_basis,
    curves_basis,
    explained_share,
    fit_law,
    place_knots,
    shifts,
)

Array = NDArray[np.float64]
MOVING_RMS_SHARE = 0.1
"""A place moves while its travel or rate exceeds this share of the largest."""
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
        Share of the recovered force's variance beyond its noise, within the band, that f + g explain on the validation runs.
    beyond
        Share that they explain of what no straight spring and damper explain; unlike `explained` it does not hang on the base fit's own.
    coupled
        The further share of it that a surface over travel and rate together explains.
    hysteresis
        The share of it that no function of travel and rate explains: memory, or another cause.
    runs
        The runs as recovered, with what the band hides of the force in their motion.
    histories
        By run `shape (3, n)`: f, g, and f + g as the test would recover it.
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
    runs: tuple[RecoveredForce, ...]
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
        more = ""
        if self.coupled > 1 - POOR:
            more = f", with travel and rate acting together {_percent(self.beyond + self.coupled)} of what is not straight"
        if self.hysteresis > 1 - POOR:
            more += f", and {_percent(self.hysteresis)} of what is not straight is no matter of travel and rate"
        return (
            f"{' and '.join(parts)}; it explains {poor}{_percent(self.explained)} of the unknown force at {self.place} on validation runs"
            f"{more} (a description, not a physical law)"
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


def fit_free_form(recovered: Sequence[RecoveredForce], seed: int = 11) -> FreeForm | None:
    """Fit a free-form law to the force recovered in the training runs, and judge it on the validation runs.

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
    training = [run for run in recovered if not run.validation]
    reach = [np.concatenate([getattr(run, name) for run in training] or [np.zeros(1)]) for name in ("travel", "rate")]
    moving = np.any([np.abs(x) > MOVING_RMS_SHARE * np.abs(x).max() for x in reach], axis=0)
    if not moving.any():
        return None
    knots = [place_knots(x[moving], N_KNOTS) for x in reach]
    basis, penalties = curves_basis(*knots)
    fitted = fit_law(recovered, basis, penalties)
    line, law, together = (
        _judge(item) for item in (fit_law(recovered, _straight, [np.zeros((2, 2))]), fitted, fit_law(recovered, *coupled_basis(*knots)))
    )
    random = np.random.Generator(np.random.PCG64(seed))
    moved = shifts(fitted)
    draws = bootstrap(fitted, DRAWS, random) + random.standard_normal((DRAWS, len(moved))) @ moved
    left = max(1.0 - line, 1e-12)
    beyond, together = ((share - line) / left for share in (law, together))
    first = recovered[0]
    return FreeForm(
        first.place.label,
        first.units,
        _curve(0, reach[0][moving], fitted, draws),
        _curve(1, reach[1][moving], fitted, draws),
        first.stiffness,
        first.damping,
        law,
        beyond,
        max(together - beyond, 0.0),
        min(1.0 - max(beyond, together), 1.0),
        fitted.runs,
        {run.run: _histories(run, fitted) for run in fitted.runs},
    )


def _judge(fitted: FittedLaw) -> float:
    """Return the share that a law explains on the validation runs; where there are none, on the training runs."""
    judged = [run for run in fitted.runs if run.validation] or fitted.runs
    return explained_share(judged, [fitted.force(run.travel, run.rate) for run in judged])


def _histories(run: RecoveredForce, fitted: FittedLaw) -> Array:
    still = np.zeros_like(run.time)
    f, g = fitted.force(run.travel, still), fitted.force(still, run.rate)
    return np.array([f, g, run.observable(f + g)])


def _straight(travel: Array, rate: Array) -> Array:
    return np.column_stack([travel, rate])


def _curve(axis: int, reach: Array, fitted: FittedLaw, draws: Array) -> Curve:
    """Return f (axis 0) or g (axis 1)."""
    x = np.linspace(float(np.percentile(reach, 1)), float(np.percentile(reach, 99)), POINTS)
    columns = fitted.basis(np.zeros_like(x), x) if axis else fitted.basis(x, np.zeros_like(x))
    low, high = np.percentile(draws @ columns.T, [5, 95], axis=0)
    own = sum(float((run.observable(_histories(run, fitted)[axis]) ** 2).sum()) for run in fitted.runs)
    return Curve(x, columns @ fitted.coefficients, low, high, own / sum(float((run.force**2).sum()) for run in fitted.runs))


def _stretch(curve: Curve, scale: float, unit: str, force: str) -> str:
    steps = np.diff(curve.force)
    verb = "grows" if (steps >= 0).all() else "falls" if (steps <= 0).all() else "goes"
    low, high = scale * curve.x[0], scale * curve.x[-1]
    return f"between {low:.3g} and {high:.3g} {unit} the force {verb} from {curve.force[0]:.3g} to {curve.force[-1]:.3g} {force}"


def _percent(share: float) -> str:
    return f"{100 * max(share, 0.0):.{1 if 0.985 < share < 1 else 0}f} %"


__all__ = ["Curve", "FreeForm", "RecoveredForce", "fit_free_form", "recover", "strongest"]
