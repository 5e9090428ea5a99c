"""What does a rough road make of a vehicle with force laws? Drawn roads tell.

A linear vehicle answers roughness in the same way wherever it drives, all channels in step. One with laws does not: friction that sticks
before the hump slides on it, a damper that is softer in one direction turns slow motion into faster one. Nor does it answer the hump in the
same way: friction that roughness shakes loose holds it less. So roads are drawn, and the fitted vehicle driven over them with the hump and
without it. How rough they are follows from the lead-ins, by the vehicle with its laws: a suspension that sticks passes a smooth road on as
a linear one would a rough road.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import scipy
from numpy.typing import NDArray

from vehgen.diagnose.detect.noise_floor import SITES_DIFFER, lead_in_lines
from vehgen.diagnose.detect.road_error import under_hump
from vehgen.diagnose.fits.model_fit import ModelFit
from vehgen.fit.lead_in import lead_in
from vehgen.fit.least_squares import LeastSquaresFit
from vehgen.fit.misfit import Misfit, Noises
from vehgen.fit.noise import EVEN, LARGEST_LEVEL, SMALLEST_LEVEL, DrawnRoughness, Noise
from vehgen.fit.road_answer import KNOT_WAVENUMBERS, RoadAnswer
from vehgen.fit.trial import Trial
from vehgen.road import MeasuredProfile
from vehgen.road.iso8608 import REFERENCE_CYCLES_PER_M
from vehgen.simulate import Scenario

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]
ROADS_DRAWN, ROADS_TRIED, ROADS_MIRRORED = 40, 6, 16
"""Roads drawn for every run, while their roughness is sought, and driven over upside down, too, for what does not cancel then."""
ROAD_SEED = 20
SPACING_M = 0.02
"""Spacing of a drawn road's points [m]."""
BEYOND_M = 5.0
"""A drawn road reaches so far beyond the run at both ends, and beyond the axles behind the first."""
LOWEST_WAVENUMBER = 0.02
"""Longer waves of a drawn road are left out [cycles/m]: a vehicle follows them."""
LEVEL_UPDATES = 10
"""So often are levels changed by what their roads make of the vehicle."""
SMOOTHED = 5
"""Densities are averaged over so many lines."""


def noises_of_laws(fit: ModelFit, noises: Noises) -> Noises:
    """Return noises with what roughness makes of the fitted vehicle's laws under humps; those of a linear vehicle as they are."""
    if not any(item.laws for item in fit.least_squares.misfit.problem.trials[0].simulator.model.elements):
        return noises
    runs = [DrawnRun(part, number, noises[trial.name]) for part in fit.parts for number, trial in enumerate(part.misfit.problem.trials)]
    rough = [run for run in runs if run.trial.scenario.over_humps_alone and np.any(run.lead.levels > 2 * SMALLEST_LEVEL)]
    if not rough:
        return noises
    found = {}
    for run, levels in zip(rough, find_levels(rough), strict=True):
        drawn = replace(run.lead, levels=levels, louder=None, drawn=run.density(levels, ROADS_DRAWN))
        lines, answer = run.fit.misfit.residual_spectrum(run.fit.x)[run.number]
        before, now = (item.unshifted(run.trial.recording.values) for item in (run.fit.misfit.noises[run.trial.name], drawn))
        found[run.trial.name] = under_hump(lines + run.fit.misfit.signal_lines(run.number, now - before), answer, drawn)
    return noises | found


def find_levels(runs: Sequence[DrawnRun]) -> list[Array]:
    """Return each run's road, levels `shape (len(KNOTS),)` [m^3], by which the vehicle with its laws would have shown the lead-ins.

    The levels of the linear vehicle, times factors: each step multiplies them by what the likeliest would be if their roads added up (the
    multiplicative update of Itakura-Saito's distance; doi:10.1162/neco.2008.04-08-771). First all runs share the factors; in later steps
    a run has one of its own, too.
    """
    leads = [lead_in_lines(part, run.fit.misfit.band) if (part := lead_in(run.trial)) is not None else None for run in runs]
    levels = [run.lead.levels for run in runs]
    for step in range(LEVEL_UPDATES):
        sums = [_asked(run, own, lead) for run, own, lead in zip(runs, levels, leads, strict=True)]
        more, less = np.sum(sums, axis=0)
        shared = np.sqrt(np.maximum(more, 1e-12) / np.maximum(less, 1e-12))
        for i, own in enumerate(sums):
            alone = np.sqrt((own[0].sum() + SITES_DIFFER) / ((own[1] * shared).sum() + SITES_DIFFER)) if 2 * step >= LEVEL_UPDATES else 1.0
            levels[i] = np.clip(levels[i] * shared * alone, SMALLEST_LEVEL, LARGEST_LEVEL)
    return levels


def _asked(run: DrawnRun, levels: Array, lead: tuple[Complex, RoadAnswer] | None) -> Array:
    """Return what a lead-in has of roughness and what drawn roads make of it, in units of the latter, knot by knot, `shape (2, n)`."""
    if lead is None:
        return np.zeros((2, len(KNOT_WAVENUMBERS)))
    lines, answer = lead
    drawn = replace(run.lead, louder=None, drawn=run.density(levels, ROADS_TRIED, hump=False))
    total = _own_densities(drawn, answer)
    share = np.maximum(total - _own_densities(replace(drawn, drawn=None, levels=EVEN), answer), 0.0) / total
    weights = answer.weights.T
    return np.stack([weights @ (share * np.abs(lines) ** 2 / total).sum(axis=1), weights @ share.sum(axis=1)])


@dataclass(frozen=True)
class DrawnRun:
    """Run `number` of a fit, to be driven over drawn roads; `lead` is the noise of its lead-in."""

    fit: LeastSquaresFit
    number: int
    lead: Noise

    @property
    def trial(self) -> Trial:
        """The run itself."""
        return self.fit.misfit.problem.trials[self.number]

    def density(self, levels: Array, count: int, *, hump: bool = True) -> DrawnRoughness:
        """Return what `count` roads of such levels `shape (len(KNOTS),)` [m^3] add to the channels, on the run's humps or without them."""
        misfit: Misfit = self.fit.misfit
        scenario = misfit.scenario(self.fit.x, self.number)
        flat = replace(scenario, track=replace(scenario.track, parts=()))
        roads = self._roads(scenario, levels, count)
        driven = scenario if hump else flat
        plain = self._motion(driven)
        mean = self._mean(driven, flat, roads[:ROADS_MIRRORED]) if hump else plain
        added = np.array([self._lines(self._motion(_over(driven, road)) - mean) for road in roads])
        power = np.einsum("rni,rnj->nij", added, added.conj()) / count
        smooth = scipy.ndimage.uniform_filter1d(power, SMOOTHED, axis=0)
        shift = misfit.errors[self.number].read(mean - plain, self.trial.recording.dt, misfit.errors_of(self.fit.x, self.number))
        return DrawnRoughness(misfit.frequency(self.number), np.asarray(smooth, dtype=np.complex128), shift)

    def _mean(self, humps: Scenario, flat: Scenario, roads: Sequence[MeasuredProfile]) -> Array:
        """Return the mean of what the sensors' places do on humps over roads, less what the roads do without humps.

        `shape (n_samples, n_channels)`. Each road is driven over upside down, too: what a linear vehicle does on it cancels.
        """
        ways = [way for road in roads for way in (road, replace(road, heights=-road.heights))]
        return np.asarray(np.mean([self._motion(_over(humps, way)) - self._motion(_over(flat, way)) for way in ways], axis=0))

    def _roads(self, scenario: Scenario, levels: Array, count: int) -> list[MeasuredProfile]:
        """Return roads under all that the run drives over; those of other levels are the same, louder or quieter."""
        behind = float(self.trial.simulator.model.wheel_offsets(self.trial.values).max(initial=0.0))
        first, last = scenario.speed.distance(scenario.time[[0, -1]])
        start, points = first - behind - BEYOND_M, int((last - first + behind + 2 * BEYOND_M) / SPACING_M)
        wavenumber = np.asarray(np.fft.rfftfreq(points, SPACING_M)[1:], dtype=np.float64)
        density = replace(self.lead, levels=levels).level(wavenumber) * (REFERENCE_CYCLES_PER_M / wavenumber) ** 2
        density[wavenumber < LOWEST_WAVENUMBER] = 0.0
        size = np.sqrt(density * points / (4 * SPACING_M))
        random = np.random.default_rng([ROAD_SEED, self.number])
        found = []
        for _ in range(count):
            lines = size * (random.standard_normal(len(size)) + 1j * random.standard_normal(len(size)))
            heights = np.fft.irfft(np.concatenate([[0.0], lines]), points)
            found.append(MeasuredProfile(start + SPACING_M * np.arange(points), heights))
        return found

    def _motion(self, scenario: Scenario) -> Array:
        misfit, x = self.fit.misfit, self.fit.x
        values = misfit.problem.space.values(misfit.split(x)[0])[None]
        return np.asarray(misfit.respond(self.number, values, misfit.adjusted(x), misfit.errors_of(x, self.number), scenario=scenario)[0])

    def _lines(self, motion: Array) -> Complex:
        misfit = self.fit.misfit
        return misfit.channel_lines(self.number, motion, misfit.errors_of(self.fit.x, self.number))


def _over(scenario: Scenario, road: MeasuredProfile) -> Scenario:
    """Return a scenario with a road beneath what it drives over."""
    return replace(scenario, track=replace(scenario.track, parts=(*scenario.track.parts, road)))


def _own_densities(noise: Noise, answer: RoadAnswer) -> Array:
    """Return the density of each channel, `shape (n, n_channels)`."""
    return np.asarray(np.diagonal(noise.density(answer), axis1=1, axis2=2).real)
