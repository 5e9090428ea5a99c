"""One law in a group of axles, taken apart: the same law at each of them, with numbers of its own."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np

from vehgen.diagnose.detect.detection import Detection
from vehgen.diagnose.fits.candidate import Candidate
from vehgen.diagnose.fits.model_fit import ModelFit
from vehgen.diagnose.select.fitter import Fitter
from vehgen.diagnose.select.ranking import SearchRound, merit, simplest_first
from vehgen.diagnose.select.search import CONTENDER


def with_members(found: SearchRound, candidates: Sequence[Candidate], fit_one: Callable[[Candidate], ModelFit | None]) -> SearchRound:
    """Return a round in which the effect of the leading group has been fitted at every axle of it alone, too.

    Parameters
    ----------
    found
        The round; one without a leading group stays as it is.
    candidates
        Every effect at every place.
    fit_one
        Fits a candidate on top of the round's model.
    """
    group = leading_group(found)
    if group is None:
        return found
    laws, known = _laws(group.last), {fit.last.label for fit in found.fits}
    wanted = [item for item in candidates if item.effect.name in laws and item.place in group.last.members and item.label not in known]
    fits = [fit for item in wanted if (fit := fit_one(item)) is not None]
    return replace(found, fits=(found.fits[0], *sorted([*found.fits[1:], *fits], key=merit)))


def member_seeds(found: SearchRound) -> list[ModelFit]:
    """Return the best fits at one axle of the leading group: of its law's special case, then of the law itself."""
    group = leading_group(found)
    if group is None:
        return []
    here = [fit for fit in found.fits if fit.last.place in group.last.members]
    own = [[fit for fit in here if fit.last.effect.name == name] for name in _laws(group.last)]
    return [fits[0] for fits in own if fits]


def leading_group(found: SearchRound) -> ModelFit | None:
    """Return the best fit of a law that a group of axles has alike, where it is nearly as good as the best fit of all."""
    group = next((fit for fit in found.fits if len(fit.last.members) > 1), None)
    return group if group is not None and group.training <= CONTENDER * found.fits[0].training else None


def with_rest(look: SearchRound, group: ModelFit, candidates: Sequence[Candidate], detection: Detection) -> SearchRound:
    """Return a round beside a law at one axle of a group in which the law at the others is fitted from where the group's fit ended, too.

    Parameters
    ----------
    look
        The round beside the one axle.
    group
        The fit of the law that all axles have alike.
    candidates
        Every effect at every place, beside the one axle's.
    detection
        What the runs are fitted to.
    """
    alone = look.current
    moved = _moved(alone, group)
    if moved is None:
        return look
    numbers = tuple(group.least_squares.values[-group.n_effect_parameters :])
    fitter = Fitter(detection, moved, look.passed)
    wanted = [item for item in candidates if item.effect.name == alone.last.effect.name and item.place in group.last.members]
    wanted = [item for item in wanted if item.place != alone.last.place]
    found = [fit for item in wanted if (fit := fitter.fit(item, [numbers[: len(item.parameters)]], slow_first=False)) is not None]
    best: dict[tuple[tuple[str, str], ...], ModelFit] = {}
    for fit in sorted([*look.fits, *found], key=merit):
        best.setdefault(fit.key, fit)
    return replace(look, fits=tuple(simplest_first(list(best.values()), alone)))


def _moved(alone: ModelFit, group: ModelFit) -> ModelFit | None:
    """Return the fit at one axle, moved to where the group's fit ended; None where the two have other unknowns."""
    own, other = alone.least_squares, group.least_squares
    n = own.misfit.n_parameters - alone.n_effect_parameters
    common = own.misfit.problem.space.names[:n] == other.misfit.problem.space.names[:n]
    if (
        not common
        or own.misfit.shared
        or other.misfit.shared
        or len(own.x) - own.misfit.n_parameters != len(other.misfit.split(other.x)[1])
    ):
        return None
    values = np.concatenate([other.values[:n], other.values[n : n + alone.n_effect_parameters]])
    unit = np.clip(own.misfit.problem.space.unit(values), 0.0, 1.0)
    x = np.concatenate([unit, other.misfit.split(other.x)[1]])
    return replace(alone, least_squares=replace(own, x=x, linearisation=None))


def _laws(candidate: Candidate) -> tuple[str, ...]:
    return (candidate.effect.special_case, candidate.effect.name)
