"""Stage 2, localise: where the model errs, and which effects are worth fitting there."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from vehgen.diagnose import thresholds as limit
from vehgen.diagnose.fits.candidate import Candidate
from vehgen.diagnose.fits.model_fit import ModelFit
from vehgen.diagnose.localise.unknown_force import Place, PlaceResult, list_places, score_locations
from vehgen.effects.evidence import PlaceEvidence
from vehgen.fit.linearisation import Lineariser
from vehgen.fit.parallel import HERE, Runner

ONCE = 1_000_000
"""The derivatives by nuisances serve for all places: they differ little, and take most of the time."""


def localise(fit: ModelFit, runner: Runner = HERE) -> tuple[list[PlaceResult], list[PlaceResult]]:
    """Test every place on what a fit leaves; return all results, best first, and the smallest hypotheses that reach the floor.

    The places are tested wherever a runner works.
    """
    misfit = fit.least_squares.misfit
    results = score_locations(misfit, fit.least_squares.x, list_places(misfit), Lineariser(misfit, ONCE), runner)
    results.sort(key=lambda item: (item.chi, item.unknowns))
    nowhere = next(item for item in results if item.place.kind == "none")
    excess = max(nowhere.chi**2 - 1, 0.0)
    reached = [item for item in results if item.place.kind != "none" and _reaches(item, excess)]
    fewest = min((item.unknowns for item in reached), default=0)
    return results, [item for item in reached if item.unknowns == fewest]


def localise_at(fit: ModelFit, name: str) -> list[PlaceResult]:
    """Test the places of one part alone, such as an axle's suspension and tyre, on what a fit leaves; return the results, best first."""
    misfit = fit.least_squares.misfit
    places = [place for place in list_places(misfit) if place.name == name]
    results = score_locations(misfit, fit.least_squares.x, places, Lineariser(misfit, ONCE)) if places else []
    return sorted(results, key=lambda item: (item.chi, item.unknowns))


def _reaches(item: PlaceResult, excess: float) -> bool:
    return item.chi <= limit.PLACE_PASSES or item.chi**2 - 1 <= limit.PLACE_SHARE * excess


def one_force(passed: Sequence[PlaceResult]) -> bool:
    """Return whether one unknown force at a single place suffices."""
    return any(item.place.rows and item.unknowns == 1 for item in passed)


def none_explains(passed: Sequence[PlaceResult]) -> bool:
    """Return whether unknown forces suffice at no single place."""
    return not any(item.place.rows for item in passed)


def suffices(passed: Sequence[PlaceResult], base: ModelFit) -> bool:
    """Return whether one unknown force at a single place leaves noise, so that a second cause is not needed."""
    least = max(limit.PLACE_PASSES**2 - 1, limit.PLACE_CLEAR * max(base.training - 1, 0.0))
    return any(item.place.rows and item.unknowns == 1 and item.chi**2 - 1 <= least for item in passed)


def shortlist(
    base: ModelFit, candidates: Sequence[Candidate], places: Sequence[PlaceResult], passed: Sequence[PlaceResult]
) -> list[Candidate]:
    """Return the candidates worth fitting: those that live at the places left, and those that no single force explains.

    A sensor's effects are tried where leaving out the sensor or one of its channels helps; effects of the whole vehicle, and those at a
    body's axles and hinges, where one unknown force at one place does not suffice. A channel whose absence leaves more than noise says
    nothing of the vehicle: the quietest one, and the one next to the cause, hold most of any gap.
    """
    silent = not any(item.place.rows for item in passed)
    if silent and min((item.chi for item in passed), default=np.inf) > limit.PLACE_PASSES:
        return list(candidates)
    names = {owner(item.place) for item in passed if item.place.rows}
    single = suffices(passed, base)
    if not single:
        vehicle = base.least_squares.misfit.problem.trials[0].run.vehicle
        names |= {name for name, axle in vehicle.axles.items() if axle.body in names}
        names |= {name for name, hinge in vehicle.hinges.items() if not names.isdisjoint(hinge.points)}
    excess = max(base.training - 1, 1e-9)
    trials = base.least_squares.misfit.problem.trials
    channels = {channel.name: channel.sensor for trial in trials for channel in trial.recording.channels}
    silenced = {
        part for item in places if item.place.channels and _reaches(item, excess) for part in (item.place.name, *item.place.channels)
    }
    silenced |= {channels[part] for part in silenced if part in channels}
    lines = any(trial.lines for trial in trials)
    evidence = PlaceEvidence(frozenset(names), frozenset(item.place.kind for item in passed), single, frozenset(silenced), lines)
    return [candidate for candidate in candidates if candidate.effect.is_likely(candidate.place, evidence)]


def owner(place: Place) -> str:
    """Return the axle, hinge, link, body or channel that a place is of."""
    return place.name.partition(" (")[0]
