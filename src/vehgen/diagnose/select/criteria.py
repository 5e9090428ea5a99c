"""When an effect counts as found: enough of the gap closed, on validation runs too, not by chance, and alone in that."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from vehgen.diagnose import thresholds as limit
from vehgen.diagnose.fits.candidate import Candidate
from vehgen.diagnose.fits.model_fit import ModelFit
from vehgen.diagnose.select.estimates import estimate, excluded, p_value
from vehgen.diagnose.select.ranking import SearchRound, does_as_well, merit, own_numbers
from vehgen.diagnose.select.validation import validation_fall
from vehgen.effects import RunEffect

NEAREST = 4
"""So many of the effects that come nearest are told where nothing can be named."""


def excess(mean_square: float) -> float:
    """Return how far a mean square of whitened residuals is above the noise; infinite where it is not a number."""
    return max(mean_square - 1.0, 0.0) if np.isfinite(mean_square) else np.inf


def passes(fit: ModelFit, base: ModelFit) -> bool:
    """Return whether a fit closes the gap of the base, on the training runs and on validation runs, however small the gap is."""
    return closes_training(fit, base) and _closes(excess(fit.validation), excess(base.validation))


def closes_training(fit: ModelFit, base: ModelFit) -> bool:
    """Return whether a fit closes the gap of the base on the training runs, and AT_LEAST a share of it where that is small."""
    after, before = excess(fit.training), excess(base.training)
    return after <= limit.AT_LEAST * before and _closes(after, before)


def explained_shares(first: SearchRound, base: ModelFit) -> list[tuple[ModelFit, float]]:
    """Return the NEAREST leading fits with the share of the gap's excess that each explains."""
    return [(fit, 1 - excess(fit.training) / max(excess(base.training), 1e-9)) for fit in first.fits[:NEAREST]]


def freed_instead(first: SearchRound, base: ModelFit) -> ModelFit | None:
    """Return base parameters that close the gap, freed as an effect frees them, as well as any effect does; None where none do."""
    freed = next((fit for fit in first.idle[:1] if closes_training(fit, base)), None)
    return freed if freed is not None and (not first.fits or merit(freed) <= merit(first.fits[0])) else None


def _closes(after: float, before: float) -> bool:
    return after <= limit.LAW_PASSES * max(before, 1e-9) or after <= limit.LAW_CHI**2 - 1


def p_value_of(found: SearchRound, fit: ModelFit, tried: int) -> float:
    """Return the p-value of a fit's last effect, times the number of candidates that could have been tried."""
    return min(1.0, tried * p_value(found.current, fit, own_numbers(fit)))


def is_told(fit: ModelFit) -> bool:
    """Return whether the runs tell the size of the last effect of a fit.

    They do not where they ask for numbers that exclude one another, and, of an error of all runs or of a sensor, where its 90 % interval
    holds the number that changes nothing. Of a law it may: a stop that is surely there can be of any stiffness.
    """
    if excluded(fit):
        return False
    effect = fit.last.effect
    if not isinstance(effect, RunEffect):
        return True
    interval = estimate(fit)[effect.parameters[0].name].interval
    return interval is None or not interval[0] <= effect.neutral <= interval[1]


def fall(found: SearchRound, fit: ModelFit) -> float:
    """Return by how much -2 ln of the likelihood falls on the training runs, beyond the price of an effect's numbers."""
    return found.current.squares - merit(fit)


def falls_as_far(found: SearchRound, fit: ModelFit, best: ModelFit) -> bool:
    """Return whether -2 ln L falls with a fit nearly as far as with the best one, on the training runs and on validation runs."""
    base = found.current
    on_training = fall(found, fit) >= limit.FAINT_TIE * fall(found, best)
    return on_training and validation_fall(base, fit) >= limit.FAINT_TIE * validation_fall(base, best)


def tied(found: SearchRound, best: ModelFit) -> list[ModelFit]:
    """Return the fits of a round that do as well as the best: within the slack of TIE, or of FAINT_TIE where chi shows no gap.

    Not those that do no better, but ask of the base what its file does not allow, nor an error of all runs or of a sensor, or a
    line, that may be none.
    """
    before = excess(found.current.training)
    others = [item for item in found.fits if item.key != best.key and not same(item.last, best.last) and not _asks_for_more(item, best)]
    as_well = [
        item for item in others if (falls_as_far(found, item, best) if found.faint else does_as_well(item.training, best.training, before))
    ]
    return [
        item for item in as_well if not (isinstance(item.last.effect, RunEffect) or item.last.effect.solved_parameters) or is_told(item)
    ]


def _asks_for_more(fit: ModelFit, best: ModelFit) -> bool:
    """Return whether a fit takes base parameters to the ends of their ranges where the best one takes none there, and does no better.

    So relaxation does that stands in for a damper's mount: beside it the damper itself would have to be weaker than its file allows.
    """
    return bool(_base_at_bounds(fit)) and not _base_at_bounds(best) and merit(fit) >= merit(best)


def _base_at_bounds(fit: ModelFit) -> set[str]:
    """Return the base parameters at the ends of their ranges."""
    return set(fit.least_squares.on_bound).difference(*(item.parameters for item in fit.effects))


def same(one: Candidate, other: Candidate) -> bool:
    """Return whether one candidate holds the other: as a special case, or as the same effect of every tyre or of a group of axles."""
    return one.holds(other) or other.holds(one) or one.is_alike(other)


def unfinished(fit: ModelFit, base: ModelFit) -> bool:
    """Return whether a fit leaves enough to look for a further effect: more than noise, and more than a law's form may be wrong by."""
    return any(
        after > max(limit.AGAIN**2 - 1, limit.FORM * before)
        for after, before in ((excess(fit.training), excess(base.training)), (excess(fit.validation), excess(base.validation)))
    )


def adds(found: SearchRound, fit: ModelFit) -> bool:
    """Return whether a further effect is needed and enough.

    It leaves FURTHER of what was left, or noise, on validation runs too. At the place of an effect found before it must leave noise and
    attach to another part (a tyre, a suspension): two laws of one suspension can imitate a third. One with which more than CROWD others
    tie says nothing.
    """
    if len(tied(found, fit)) > limit.CROWD:
        return False
    before = (excess(found.current.training), excess(found.current.validation))
    after = (excess(fit.training), excess(fit.validation))
    floor = limit.NOISE_FLOOR**2 - 1
    noise = all(item <= floor and item <= limit.AT_LEAST * old for item, old in zip(after, before, strict=True))
    neighbours = [item.effect.attaches for item in found.current.effects if item.place == fit.last.place]
    if neighbours:
        return noise and fit.last.effect.attaches not in neighbours
    return noise or all(item <= limit.FURTHER * max(old, 1e-9) for item, old in zip(after, before, strict=True))


def seeds(found: SearchRound) -> list[ModelFit]:
    """Return the fits of a round that explain part of the gap, at different places: first effects of pairs."""
    before = excess(found.current.training)
    chosen: list[ModelFit] = []
    for fit in found.fits:
        if excess(fit.training) <= limit.PARTLY * before and all(fit.last.place != item.last.place for item in chosen):
            chosen.append(fit)
        if len(chosen) == limit.SEEDS:
            break
    return chosen


def needs_both(pair: ModelFit, fits: Sequence[ModelFit]) -> bool:
    """Return whether the second effect of a pair alone leaves TIE times the pair's excess or more."""
    alone = [item for item in fits if item.key == pair.key[-1:]]
    least = max(excess(pair.training), limit.NOISE_FLOOR**2 - 1)
    return all(excess(item.training) >= limit.TIE * least for item in alone)
