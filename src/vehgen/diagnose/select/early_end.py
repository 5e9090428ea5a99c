"""Ends a search early: beside a candidate that explains everything, without strain, only what may explain as much has to be fitted."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from vehgen.diagnose import thresholds as limit
from vehgen.diagnose.fits.candidate import Candidate
from vehgen.diagnose.fits.model_fit import ModelFit
from vehgen.diagnose.fits.multi_start import BESIDE_SETTLED, HOPELESS
from vehgen.diagnose.fits.screening import FirstOrderGains, reaches_a_body
from vehgen.diagnose.select.criteria import excess
from vehgen.diagnose.select.fitter import Fitter
from vehgen.diagnose.select.freed_base import idle_instead
from vehgen.diagnose.select.ranking import numbers_at_ends
from vehgen.effects.kinds import ShakingEffect
from vehgen.fit.parallel import HERE, Runner

MOST_AT_ONCE = 4
"""So many candidates are fitted, all motions at once, until one settles a gap."""
RIVAL = 0.3
"""Beside one that does, candidates are fitted whose first-order gain is this share of its own, or more."""
AS_FAR = 0.7
"""What shakes the vehicle is fitted beside it where its first order, which tells what it gains, is this share of what that one gained."""
AS_MUCH = 2.0
"""Rough fits that leave so many times the excess that it leaves may end as low: its own special case did, and was not refined."""
UNSTRAINED = 3.5
"""It supposes errors of runs and sensors of no more than so many standard deviations."""


def settle(
    fitter: Fitter,
    gains: FirstOrderGains,
    candidates: Sequence[Candidate],
    each: Callable[[ModelFit], None],
    runner: Runner = HERE,
    kept_at: str = "",
) -> list[Candidate]:
    """Fit the candidates of the largest first-order gains until one settles the gap of the base; those at `kept_at` stay its rivals.

    Where a single force explains the gap at no place, they are followed by laws of bodies that are none. Every fit is handed to
    `each` as soon as it is made. Beside a base at its bounds none settles that does no more than what it set free. Where one settles the
    gap, the fitter refines from then on only what leaves next to nothing, too, or about as much as that one.

    Returns
    -------
    The candidates that are left to be fitted: all where none settles the gap.
    """
    ranked = [(*gains.of(item), item) for item in candidates]
    ranked.sort(key=lambda known: -known[0])
    strained = bool(fitter.base.least_squares.on_bound)
    others = [known for known in ranked[MOST_AT_ONCE:] if fitter.nowhere and reaches_a_body(known[-1])]
    tried = set()
    for fit in fitter.fit_all_begun([(item, begin) for _, begin, item in ranked[:MOST_AT_ONCE] + others[:MOST_AT_ONCE]], runner):
        each(fit)
        tried.add(fit.key[-1])
        if _settles(fit) and not (strained and idle_instead(fit, fitter.fit_without)):
            own = next(gain for gain, _, item in ranked if (item.effect.name, item.place) == fit.key[-1])
            share = excess(fit.training) / max(excess(fitter.base.training), 1e-9)
            fitter.hopeless = min(HOPELESS, max(BESIDE_SETTLED, AS_MUCH * share))
            rest = [(gain, item) for gain, _, item in ranked if (item.effect.name, item.place) not in tried]
            fallen = fitter.base.squares - fit.squares
            rest = [(gain, item) for gain, item in rest if gain >= AS_FAR * fallen or not isinstance(item.effect, ShakingEffect)]
            return [item for gain, item in rest if gain >= RIVAL * own or item.place == kept_at or _is_inseparable(item, fit.last)]
    return list(candidates)


def _settles(fit: ModelFit) -> bool:
    """Return whether a fit leaves noise, on validation runs, too, and supposes nothing of runs and sensors that has to be explained.

    An effect at the end of its range may stand in for another one.
    """
    noise = limit.NOISE_FLOOR**2
    quiet = bool(np.isfinite(fit.validation)) and max(fit.training, fit.validation) <= noise
    return quiet and not numbers_at_ends(fit) and all(abs(item.sigmas) <= UNSTRAINED for part in fit.parts for item in part.conditions())


def _is_inseparable(item: Candidate, best: Candidate) -> bool:
    """Return whether one candidate is a special case of the other, or no run tells the two apart."""
    alike = bool(best.effect.tie_advice) and item.effect.tie_advice == best.effect.tie_advice
    return item.holds(best) or best.holds(item) or alike
