"""What to measure next, found by simulating what each of several fitted models predicts for runs that nobody has driven yet.

The predictions hold while no wheel leaves the road, unless a model says what happens then.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass
from functools import partial
from itertools import combinations, permutations
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from vehgen.diagnose.design.candidate_runs import CandidateRun, free_places, list_runs
from vehgen.diagnose.design.discrimination import FittedModel, Separation, at_most, peak, separate
from vehgen.diagnose.fits.model_fit import ModelFit
from vehgen.diagnose.phrases import join_names
from vehgen.diagnose.select.search import DiagnosisProgress
from vehgen.fit.recording import RecordedChannel
from vehgen.fit.trial import Trial
from vehgen.mechanics.outputs import PointOutput

if TYPE_CHECKING:
    from vehgen.diagnose.detect.detection import Detection

ROUGHEST_ROAD_SHARE = 20.0
"""Acceleration [m/s^2] beyond which nobody drives, unless the runs have half of it behind them."""
ENOUGH_CHI2 = 25.0
"""Expected difference of chi-squared at which two models are told apart: five standard deviations."""
NOTHING = 1.0
"""Below this distance two models are the same."""
VISIBLE = 1.5
"""chi at which an effect is strong enough to be named."""
WORTH = 2.0
"""A sensor is worth adding where it gains so many times the distance."""
REPEATS = 20
"""Nobody drives more repeats."""
LEAST_TRAVEL_M = 1e-3
"""Difference of travel [m] that a displacement sensor across a suspension shows."""
Array = NDArray[np.float64]


@dataclass(frozen=True)
class Proposal:
    """What to measure next.

    Attributes
    ----------
    models
        What is to be told apart.
    height, length, speed
        The hump [m] and the speed over it [m/s]; None where no run helps.
    distance
        Expected difference of chi-squared, after a refit of the wrong model to all runs.
    channel, times
        Where the predictions then differ most, and by how many standard deviations of its noise.
    added
        A sensor to add, in words; None where those of the runs suffice.
    separates
        Whether one such run is enough.
    text
        All this in a sentence.
    """

    models: tuple[str, ...]
    height: float | None
    length: float | None
    speed: float | None
    distance: float
    channel: str
    times: float
    added: str | None
    separates: bool
    text: str

    def to_dict(self) -> dict[str, Any]:
        """Return plain data for JSON."""
        return {**asdict(self), "models": list(self.models)}


@dataclass(frozen=True)
class _Found:
    """The best answer so far: a run, the pair that it separates least, how far, with which channels, and the sensor added."""

    run: CandidateRun
    pair: tuple[FittedModel, FittedModel]
    separation: Separation
    channels: tuple[str, ...]
    added: str | None = None


def propose(detection: Detection, fits: Sequence[ModelFit], progress: DiagnosisProgress | None = None) -> Proposal | None:
    """Return the gentlest run that tells tied models apart: with the runs' sensors, else with one more, else the best there is.

    Parameters
    ----------
    detection
        Stage 1 of the diagnosis that fitted them.
    fits
        Two models or more; the first four are looked at.
    tell
        Told of progress.

    Returns
    -------
    None for fewer than two models.
    """
    fits = fits[:4]
    if len(fits) < 2 or not detection.trials[0].run.vehicle.axles:
        return None
    names = tuple(fit.label for fit in fits)
    pairs = list(permutations(fits, 2))
    found: _Found | None = None
    for adding in (False, True):
        if found is None or found.separation.distance < ENOUGH_CHI2:
            found = _search(detection, pairs, lambda item: item.distance >= ENOUGH_CHI2, found, progress, adding)
    if found is None or found.separation.distance < NOTHING:
        return _same(detection, fits, names)
    channel, times = _peak(found)
    told = f"{drive(found.run, found.added)}: the predictions of {join_names(names, 'and')} "
    told += f"then differ by {times:.2g} times the noise at {channel}"
    told += f", by {math.sqrt(found.separation.distance):.2g} standard deviations in all"
    separates = found.separation.distance >= ENOUGH_CHI2
    if not separates:
        repeats = math.ceil(ENOUGH_CHI2 / found.separation.distance)  # distances of equal runs add up
        told += f"; it takes {repeats} such runs to be sure" if repeats <= REPEATS else ", too little to be sure"
    return _proposal(names, found, channel, times, separates, told)


def propose_stronger(detection: Detection, fit: ModelFit, progress: DiagnosisProgress | None = None) -> Proposal | None:
    """Return the gentlest run in which an effect too weak to be named would stand out: the refitted base's chi above VISIBLE.

    Returns
    -------
    None where no run makes any difference.
    """
    if not detection.trials[0].run.vehicle.axles:
        return None
    found = _search(detection, [(fit, detection.base)], lambda item: 1 + item.distance / item.count >= VISIBLE**2, None, progress)
    if found is None or found.separation.distance < NOTHING:
        return None
    channel, times = _peak(found)
    chi = math.sqrt(1 + found.separation.distance / found.separation.count)
    told = f"{drive(found.run)}: {fit.label} would then leave the base model at chi {chi:.2f}, {times:.2g} times the noise at {channel}"
    return _proposal((fit.label, detection.base.label), found, channel, times, chi >= VISIBLE, told)


def _search(
    detection: Detection,
    pairs: Sequence[tuple[ModelFit, ModelFit]],
    enough: Callable[[Separation], bool],
    best: _Found | None,
    progress: DiagnosisProgress | None,
    adding: bool = False,
) -> _Found | None:
    """Return the first run that is enough, gentlest first, with the runs' own sensors or one more; else what is best."""
    fits = list({id(fit): fit for pair in pairs for fit in pair}.values())
    trials = (*detection.problem.trials, *detection.validation_runs)
    for channels in dict.fromkeys(trial.channels for trial in detection.problem.trials):
        rivals = {id(fit): FittedModel.of(fit, channels) for fit in fits}
        options: list[tuple[str | None, tuple[str, ...]]] = [(None, channels)]
        first = rivals[id(fits[0])]
        if adding:
            extra = free_places(first.trial)
            rivals = {key: rival.with_outputs(extra) for key, rival in rivals.items()} if extra else rivals
            options = [(sensor_text(item), (*channels, item.name)) for item in extra]
        joined = [(rivals[id(a)], rivals[id(b)]) for a, b in pairs]
        runs = list_runs((first.trial, *trials)) if options else []
        failed = []
        for done, run in enumerate(runs):
            if progress is not None:
                progress("next run", done, len(runs), run.name)
            if _feasible(run, trials, list(rivals.values())):
                for added, own in options:
                    found = _weakest(run, joined, own, added, lambda item: not enough(item))
                    if enough(found.separation):
                        return found
                    failed.append(found)
        best = _best(best, failed, joined)
    return best


def _best(best: _Found | None, failed: Sequence[_Found], pairs: Sequence[tuple[FittedModel, FittedModel]]) -> _Found | None:
    """Return what is best of runs that are not enough, looking closely only where a run could be better than the best so far."""
    for item in sorted(failed, key=lambda item: -item.separation.distance):
        reached = best.separation.distance if best is not None else 0.0
        reached *= WORTH if item.added is not None and best is not None and best.added is None else 1.0
        if item.separation.distance > reached:
            found = _weakest(item.run, pairs, item.channels, item.added, partial(_within, reached))
            best = found if found.separation.distance > reached else best
    return best


def _within(reached: float, item: Separation) -> bool:
    return item.distance <= reached


def _weakest(
    run: CandidateRun,
    pairs: Sequence[tuple[FittedModel, FittedModel]],
    channels: tuple[str, ...],
    added: str | None,
    stop: Callable[[Separation], bool],
) -> _Found:
    """Return the pair that a run separates least, or the first found that is reason to `stop`."""
    bounds = sorted(((at_most(*pair, run, channels), pair) for pair in pairs), key=lambda item: item[0].distance)
    separation, pair = bounds[0]
    if stop(separation):
        return _Found(run, pair, separation, channels, added)
    found = []
    for _, pair in bounds:
        found.append(_Found(run, pair, separate(*pair, run, channels), channels, added))
        if stop(found[-1].separation):
            return found[-1]
    return min(found, key=lambda item: item.separation.distance)


def _feasible(run: CandidateRun, trials: Sequence[Trial], rivals: Sequence[FittedModel]) -> bool:
    """Return whether no model predicts an acceleration that nobody would drive through."""
    limit = max([ROUGHEST_ROAD_SHARE, *(2 * _acceleration(trial.recording.values, trial.recording.channels) for trial in trials)])
    return all(_acceleration(rival.predict(run), rival.trial.recording.channels) <= limit for rival in rivals)


def _acceleration(values: Array, channels: Sequence[RecordedChannel]) -> float:
    columns = [i for i, channel in enumerate(channels) if channel.quantity == "acceleration"]
    return float(np.abs(values[:, columns]).max(initial=0.0))


def _same(detection: Detection, fits: Sequence[ModelFit], names: tuple[str, ...]) -> Proposal:
    """Say that no sensor on a body tells models apart, and whether one of a suspension's travel does."""
    channels = detection.problem.trials[0].channels
    rivals = [FittedModel.of(fit, channels) for fit in fits]
    axles = [name for name, axle in detection.problem.trials[0].run.vehicle.axles.items() if axle.suspension is not None]
    axles = [name for name in axles if all(rival.trial.run.vehicle.axles[name].suspension is not None for rival in rivals)]
    trials = (*detection.problem.trials, *detection.validation_runs)
    runs = [run for run in list_runs((rivals[0].trial, *trials)) if _feasible(run, trials, rivals)]
    told = f"{join_names(names, 'and')} predict the same in every hump run looked at, on the bodies"
    if axles and runs:
        run = runs[-1]
        travels = [rival.travels(run, axles) for rival in rivals]
        apart = np.min([np.abs(one - other).max(axis=0) for one, other in combinations(travels, 2)], axis=0)
        best = int(np.argmax(apart))
        if apart[best] >= LEAST_TRAVEL_M:
            sensor = f"the travel of the suspension of {axles[best]}"
            told += (
                f"; measure {sensor}: over a hump {run.height:.3g} m high at {run.speed:.3g} m/s they differ by {1e3 * apart[best]:.2g} mm"
            )
            return Proposal(names, run.height, run.length, run.speed, 0.0, sensor, float(apart[best] / LEAST_TRAVEL_M), sensor, True, told)
        told += " and across the suspensions"
    return Proposal(names, None, None, None, 0.0, "", 0.0, None, False, told + ": nothing that can be measured tells them apart")


def _peak(found: _Found) -> tuple[str, float]:
    return peak(*found.pair, found.run, found.channels, found.separation.x)


def _proposal(names: tuple[str, ...], found: _Found, channel: str, times: float, separates: bool, told: str) -> Proposal:
    run = found.run
    return Proposal(names, run.height, run.length, run.speed, found.separation.distance, channel, times, found.added, separates, told)


def drive(run: CandidateRun, added: str | None = None) -> str:
    """Return what to do, in words."""
    which = "the same hump" if run.same else f"a hump {run.length:.3g} m long"
    first = f"add {added} and " if added else ""
    return f"{first}drive over {which}, {run.height:.3g} m high, at {run.speed:.3g} m/s"


def sensor_text(output: PointOutput) -> str:
    """Return a sensor to add, in words."""
    quantity = "an accelerometer" if output.quantity == "acceleration" else "a pitch-rate sensor"
    return f"{quantity} on {output.place.body} at {output.place.behind}"
