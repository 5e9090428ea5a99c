"""What to measure next, found by simulating what each of several fitted models predicts for runs that nobody has driven yet.

The predictions hold while no wheel leaves the road, unless a model says what happens then.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import combinations, permutations
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from vehgen.diagnose.fitting import Fit
from vehgen.diagnose.further_runs import FurtherRun, free_places, list_runs
from vehgen.diagnose.proposal import Proposal, drive, listed, sensor_text
from vehgen.diagnose.rivals import Rival, Separation, at_most, peak, separate
from vehgen.identify.trial import Trial
from vehgen.measure import MeasuredChannel
from vehgen.mechanics.outputs import PointOutput

if TYPE_CHECKING:
    from vehgen.diagnose.pipeline import Detection

ROUGHEST = 20.0
"""Acceleration [m/s^2] beyond which nobody drives, unless the runs have half of it behind them."""
ENOUGH = 25.0
"""Expected difference of chi-squared at which two models are told apart: five standard deviations."""
NOTHING = 1.0
"""Below this distance two models are the same."""
VISIBLE = 1.5
"""chi at which an effect is strong enough to be named."""
WORTH = 2.0
"""A sensor is worth adding where it gains so many times the distance."""
REPEATS = 20
"""More repeats than this nobody drives."""
TRAVEL = 1e-3
"""Difference of travel [m] that a displacement sensor across a suspension shows."""
PHONE = {"acceleration": 0.0125, "pitch_rate": 5e-4}
"""Noise of a phone where the runs do not tell [m/s^2, rad/s]."""
Array = NDArray[np.float64]
Tell = Callable[[str, int, int, str], None]


@dataclass(frozen=True)
class _Found:
    """The best answer so far: a run, the pair that it separates least, how far, with which channels, and the sensor added."""

    run: FurtherRun
    pair: tuple[Rival, Rival]
    separation: Separation
    channels: tuple[str, ...]
    added: str | None = None


def propose(detection: Detection, fits: Sequence[Fit], tell: Tell | None = None) -> Proposal | None:
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
    if len(fits) < 2:
        return None
    names = tuple(fit.label for fit in fits)
    pairs = list(permutations(fits, 2))
    found = _search(detection, pairs, lambda item: item.distance >= ENOUGH, None, tell)
    if found is None or found.separation.distance < ENOUGH:
        found = _search(detection, pairs, lambda item: item.distance >= ENOUGH, found, tell, adding=True)
    if found is None or found.separation.distance < NOTHING:
        return _same(detection, fits, names)
    channel, times = _peak(found)
    told = f"{drive(found.run, found.added)}: the predictions of {listed(names)} then differ by {times:.2g} times the noise at {channel}"
    told += f", by {math.sqrt(found.separation.distance):.2g} standard deviations in all"
    separates = found.separation.distance >= ENOUGH
    if not separates:
        repeats = math.ceil(ENOUGH / found.separation.distance)
        told += f"; it takes {repeats} such runs to be sure" if repeats <= REPEATS else ", too little to be sure"
    return _proposal(names, found, channel, times, separates, told)


def propose_stronger(detection: Detection, fit: Fit, tell: Tell | None = None) -> Proposal | None:
    """Return the gentlest run in which an effect too weak to be named would stand out: the refitted base's chi above VISIBLE.

    Returns
    -------
    None where no run makes any difference.
    """
    found = _search(detection, [(fit, detection.base)], lambda item: 1 + item.distance / item.count >= VISIBLE**2, None, tell)
    if found is None or found.separation.distance < NOTHING:
        return None
    channel, times = _peak(found)
    chi = math.sqrt(1 + found.separation.distance / found.separation.count)
    told = f"{drive(found.run)}: {fit.label} would then leave the base model at chi {chi:.2f}, {times:.2g} times the noise at {channel}"
    return _proposal((fit.label, detection.base.label), found, channel, times, chi >= VISIBLE, told)


def _search(
    detection: Detection,
    pairs: Sequence[tuple[Fit, Fit]],
    enough: Callable[[Separation], bool],
    best: _Found | None,
    tell: Tell | None,
    adding: bool = False,
) -> _Found | None:
    """Return the first run that is enough, gentlest first, with the runs' own sensors or one more; else what is best."""
    fits = list({id(fit): fit for pair in pairs for fit in pair}.values())
    trials = (*detection.problem.trials, *detection.held_out)
    for channels in dict.fromkeys(trial.channels for trial in detection.problem.trials):
        rivals = {id(fit): Rival.of(fit, channels) for fit in fits}
        options: list[tuple[str | None, tuple[str, ...]]] = [(None, channels)]
        first = rivals[id(fits[0])]
        if adding:
            extra = free_places(first.trial)
            sigma = _sigma(first, extra)
            rivals = {key: rival.with_outputs(extra, sigma) for key, rival in rivals.items()} if extra else rivals
            options = [(sensor_text(item), (*channels, item.name)) for item in extra]
        runs = list_runs((first.trial, *trials)) if options else []
        for done, run in enumerate(runs):
            if tell is not None:
                tell("next run", done, len(runs), run.name)
            if not _feasible(run, trials, list(rivals.values())):
                continue
            for added, own in options:
                best = _better(best, run, [(rivals[id(a)], rivals[id(b)]) for a, b in pairs], own, added)
                if best is not None and enough(best.separation):
                    return best
    return best


def _better(
    best: _Found | None, run: FurtherRun, pairs: Sequence[tuple[Rival, Rival]], channels: tuple[str, ...], added: str | None
) -> _Found | None:
    """Return what is better, the best so far or a run, looking closely only where the run could be."""
    reached = best.separation.distance if best is not None else 0.0
    reached *= WORTH if added is not None and best is not None and best.added is None else 1.0
    if min(at_most(*pair, run, channels) for pair in pairs) <= reached:
        return best
    worst: _Found | None = None
    for pair in pairs:
        separation = separate(*pair, run, channels)
        if separation.distance <= reached:
            return best
        if worst is None or separation.distance < worst.separation.distance:
            worst = _Found(run, pair, separation, channels, added)
    return worst


def _feasible(run: FurtherRun, trials: Sequence[Trial], rivals: Sequence[Rival]) -> bool:
    """Return whether no model predicts an acceleration that nobody would drive through."""
    limit = max([ROUGHEST, *(2 * _acceleration(trial.measurement.values, trial.measurement.channels) for trial in trials)])
    channels = rivals[0].trial.measurement.channels
    return all(_acceleration(rival.predict(run), channels) <= limit for rival in rivals)


def _acceleration(values: Array, channels: Sequence[MeasuredChannel]) -> float:
    columns = [i for i, channel in enumerate(channels) if channel.quantity == "acceleration"]
    return float(np.abs(values[:, columns]).max(initial=0.0))


def _sigma(rival: Rival, outputs: Sequence[PointOutput]) -> Array:
    """Return the noise of sensors to add: that of the runs' own of the same quantity."""
    known: dict[str, list[float]] = {}
    for channel, sigma in zip(rival.trial.measurement.channels, rival.noise.sigma, strict=True):
        known.setdefault(channel.quantity, []).append(float(sigma))
    return np.array([np.mean(known.get(item.quantity, [PHONE[item.quantity]])) for item in outputs])


def _same(detection: Detection, fits: Sequence[Fit], names: tuple[str, ...]) -> Proposal:
    """Say that no sensor on a body tells models apart, and whether one of a suspension's travel does."""
    channels = detection.problem.trials[0].channels
    rivals = [Rival.of(fit, channels) for fit in fits]
    axles = [name for name, axle in detection.problem.trials[0].run.vehicle.axles.items() if axle.suspension is not None]
    axles = [name for name in axles if all(rival.trial.run.vehicle.axles[name].suspension is not None for rival in rivals)]
    trials = (*detection.problem.trials, *detection.held_out)
    runs = [run for run in list_runs((rivals[0].trial, *trials)) if _feasible(run, trials, rivals)]
    told = f"{listed(names)} are the same in every run with sensors on the bodies"
    if axles and runs:
        run = runs[-1]
        travels = [rival.travels(run, axles) for rival in rivals]
        apart = np.min([np.abs(one - other).max(axis=0) for one, other in combinations(travels, 2)], axis=0)
        best = int(np.argmax(apart))
        if apart[best] >= TRAVEL:
            sensor = f"the travel of the suspension of {axles[best]}"
            told += (
                f"; measure {sensor}: over a hump {run.height:.3g} m high at {run.speed:.3g} m/s they differ by {1e3 * apart[best]:.2g} mm"
            )
            return Proposal(names, run.height, run.length, run.speed, 0.0, sensor, float(apart[best] / TRAVEL), sensor, True, told)
        told += " and on the axles"
    return Proposal(names, None, None, None, 0.0, "", 0.0, None, False, told + ": nothing that can be measured tells them apart")


def _peak(found: _Found) -> tuple[str, float]:
    return peak(*found.pair, found.run, found.channels, found.separation.x)


def _proposal(names: tuple[str, ...], found: _Found, channel: str, times: float, separates: bool, told: str) -> Proposal:
    run = found.run
    return Proposal(names, run.height, run.length, run.speed, found.separation.distance, channel, times, found.added, separates, told)
