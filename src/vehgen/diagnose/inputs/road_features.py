"""A bump or a dip of the road that no run file has: found by when it would leave what the base does not explain."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from vehgen.diagnose.inputs.adjustments import RoadBump, over_bump
from vehgen.diagnose.inputs.fault import Hypothesis, MeasurementFault, place_words
from vehgen.diagnose.inputs.refits import BaseRefits
from vehgen.fit.least_squares import LeastSquaresFit
from vehgen.fit.misfit import Misfit
from vehgen.fit.trial import Trial
from vehgen.simulate import Scenario

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]
LENGTHS_M = (0.15, 0.2, 0.25, 0.3, 0.4, 0.5, 0.6, 0.75, 0.9, 1.1, 1.3, 1.6, 1.9)
"""Lengths that are tried [m]."""
SMALL_M = 5e-3
"""Height of the bump by whose answer all are known [m]: laws may answer otherwise to a high one."""
MET_AT = 0.3
"""The vehicle meets that bump after this share of a run; the answer to one elsewhere comes later or earlier."""
STEP_M = 0.02
"""Places along the road are tried so far apart."""
SHOWS_BUMP = 0.3
"""A run shows a bump that takes this share off what the base leaves beyond noise."""
FEATURE_LEFT = 0.25
"""Largest share of the excess that a bump may leave."""
HEIGHT_SCALE_M = 0.01
"""A typical height, in whose units it is fitted [m]."""
FINE_GRID = 16
"""So many points to the shortest period of a curve that is read between its points."""
LOOKS = 2
"""So often is it looked for, each time beside the vehicle that suits what was found before."""
ONE_PLACE_M = 0.5
"""Places of runs that are no farther apart are one."""


def feature_hypotheses(case: BaseRefits) -> Iterator[Hypothesis]:
    """Yield that the road has a bump or a dip that the run files do not know, of one length and height in all runs that show it."""
    if not all(trial.scenario.track.parts for trial in case.trials):
        return
    fit, found = case.refit(case.problem)[0], dict[int, _Bump]()
    for _ in range(LOOKS):
        found = _look_for(fit, found)
        if not found:
            return
        hypothesis = _hypothesis(case, found)
        fit = case.judge(hypothesis)[0]
        height = float(fit.misfit.adjusted(fit.x)[-1])
        found = {number: replace(bump, height=height) for number, bump in found.items()}
    yield hypothesis


@dataclass(frozen=True)
class _Bump:
    """A bump in one run: its place along the road [m], its length and height [m]."""

    at: float
    length: float
    height: float


def _hypothesis(case: BaseRefits, bumps: dict[int, _Bump]) -> Hypothesis:
    """Return that runs, by number, are over a bump, too, whose height is fitted."""
    first = next(iter(bumps.values()))
    roads = tuple((case.trials[number].scenario.track.parts, bump.at) for number, bump in bumps.items())

    def describe(numbers: Array) -> tuple[MeasurementFault, ...]:
        return (_fault(case, {number: replace(bump, height=float(numbers[-1])) for number, bump in bumps.items()}),)

    shared = RoadBump("road", HEIGHT_SCALE_M, length=first.length, roads=roads)
    return Hypothesis(case.trials, describe, FEATURE_LEFT, (shared,), (first.height,))


def _look_for(fit: LeastSquaresFit, known: dict[int, _Bump]) -> dict[int, _Bump]:
    """Return the bump that explains most of what a fit leaves, by the numbers of the runs that show it; empty where none does.

    Parameters
    ----------
    fit
        A fit to all runs, over the bumps that are `known`.
    known
        What was found before, the last adjustment of the fit: it is looked for anew.
    """
    left = fit.misfit.whitened_spectrum(fit.x)
    runs = [_Run.of(fit, number, left[number], known.get(number)) for number in range(len(left))]
    best: tuple[float, dict[int, _Bump]] = 0.0, {}
    for length in LENGTHS_M:
        answers = [run.answers(length) for run in runs]
        for sign in (1.0, -1.0):
            peaks = [int(np.argmax(sign * numerators)) for _, numerators, _ in answers]
            gains = [max(sign * own[1][peak], 0.0) ** 2 / own[2] for own, peak in zip(answers, peaks, strict=True)]
            shown = [number for number, gain in enumerate(gains) if gain > SHOWS_BUMP * max(runs[number].excess, 1.0)]
            if shown and sum(gains[number] for number in shown) > best[0]:
                height = sum(answers[i][1][peaks[i]] for i in shown) / sum(answers[i][2] for i in shown)
                bumps = {i: _Bump(float(answers[i][0][peaks[i]]), length, float(height)) for i in shown}
                best = sum(gains[number] for number in shown), bumps
    return best[1]


@dataclass(frozen=True)
class _Run:
    """One run of a fit: its unknowns x without the bump that is looked for, and what is left, whitened `shape (n_lines, n_channels)`."""

    misfit: Misfit
    number: int
    x: Array
    left: Complex

    @classmethod
    def of(cls, fit: LeastSquaresFit, number: int, left: Complex, known: _Bump | None) -> _Run:
        """Return run `number` of a fit that left whitened lines over a bump that is `known`."""
        misfit, x = fit.misfit, fit.x.copy()
        if known is None:
            return cls(misfit, number, x, left)
        x[misfit.n_parameters + len(misfit.shared) - 1] = 0.0
        run = cls(misfit, number, x, left)
        return replace(run, left=left + run.added_lines(known))

    @property
    def excess(self) -> float:
        """The squares of what is left, beyond those of noise."""
        return float(2 * (np.abs(self.left) ** 2).sum() - 2 * self.left.size)

    @cached_property
    def scenario(self) -> Scenario:
        """What the run drives through without the bump."""
        return self.misfit.scenario(self.x, self.number)

    def added_lines(self, bump: _Bump) -> Complex:
        """Return what a bump adds to the whitened lines."""
        misfit, error = self.misfit, self.misfit.errors_of(self.x, self.number)
        values, numbers = misfit.problem.space.values(misfit.split(self.x)[0])[None], misfit.adjusted(self.x)
        roads = (over_bump(self.scenario, bump.at, bump.length, bump.height), self.scenario)
        over, without = (misfit.respond(self.number, values, numbers, error, scenario=road)[0] for road in roads)
        return misfit.whiten(self.number, misfit.channel_lines(self.number, over - without, error))

    def answers(self, length: float) -> tuple[Array, Array, float]:
        """Return places along the road [m], and a bump's height at each by linear least squares: its numerators, and their denominator.

        Where it would lie on a hump, another hump is asked for elsewhere.
        """
        scenario = self.scenario
        along, kept = scenario.speed.distance(scenario.time), scenario.start + scenario.skipped * scenario.decimation * scenario.dt
        met = kept + MET_AT * (scenario.time[-1] - kept)
        answer = self.added_lines(_Bump(float(np.interp(met, scenario.time, along)), length, SMALL_M)) / SMALL_M
        places = np.arange(np.interp(kept, scenario.time, along), along[-1], STEP_M)
        product = (np.conj(answer) * self.left).sum(axis=1)
        numerators = shifted_sums(product, self.misfit.frequency(self.number), np.interp(places, along, scenario.time) - met)
        for hump in scenario.humps:
            numerators[(places < hump.end) & (places + length > hump.at)] = 0.0
        return places, numerators, float(2 * (np.abs(answer) ** 2).sum())


def shifted_sums(lines: Complex, frequency: Array, later: Array) -> Array:
    """Return 2 Re(sum of lines exp(2 pi i f t)) of evenly spaced lines at frequencies [Hz], at times `later shape (n,)` [s].

    By a transform onto a grid of 16 points to the shortest period, straight between them: 2 % off at most.
    """
    spacing = float(frequency[1] - frequency[0])
    numbers = np.rint(frequency / spacing).astype(int)
    points = FINE_GRID * (int(numbers[-1]) + 1)
    spectrum = np.zeros(points // 2 + 1, dtype=np.complex128)
    spectrum[numbers] = lines
    curve = np.fft.irfft(spectrum, points) * points
    return np.asarray(np.interp(later, np.arange(points) / (points * spacing), curve, period=1 / spacing))


def _fault(case: BaseRefits, bumps: dict[int, _Bump]) -> MeasurementFault:
    bump, runs = next(iter(bumps.values())), tuple(case.trials[number].name for number in bumps)
    shape = f"about {bump.length:.2g} m long and {1e3 * abs(bump.height):.0f} mm {'high' if bump.height > 0 else 'deep'}"
    kind = "a bump" if bump.height > 0 else "a dip"
    message = f"the road has {kind} that the run files do not know, {shape}, {_where(case.trials, bumps)} {place_words(runs, case.runs)}"
    cure = f"look at the road there, and write {kind} into the run files as another `hump`, or drive elsewhere"
    return MeasurementFault("road_feature", runs, (), message, cure, bump.height, "m")


def _where(trials: Sequence[Trial], bumps: dict[int, _Bump]) -> str:
    """Return where runs meet a bump, in words: along the road, or behind the hump where that is what they have in common."""
    places = np.array([bump.at for bump in bumps.values()])
    humps = [trials[number].scenario.humps for number in bumps]
    behind = places - np.array([own[0].at for own in humps]) if all(humps) else places
    if np.ptp(places) > ONE_PLACE_M >= np.ptp(behind):
        return f"beginning {abs(behind.mean()):.1f} m {'behind' if behind.mean() > 0 else 'ahead of'} the begin of the hump"
    if np.ptp(places) > ONE_PLACE_M:
        return f"beginning at {', '.join(f'{place:.1f}' for place in places)} m along the road"
    return f"beginning {places.mean():.1f} m along the road"
