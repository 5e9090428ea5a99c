"""Stage 1, detect: how far the recalibrated base model is above the noise, run by run, channel by channel, band by band."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from vehgen.diagnose.detect.drawn_roughness import noises_of_laws
from vehgen.diagnose.detect.noise_floor import NoiseFloor, are_same_noises, find_noise_floor
from vehgen.diagnose.detect.numerical_floor import numerical_floor
from vehgen.diagnose.detect.rig_noise import rig_noises
from vehgen.diagnose.detect.road_error import measured_profiles, road_noises
from vehgen.diagnose.detect.splitting import hump_height, split_by_gap, split_runs
from vehgen.diagnose.detect.steady_lines import steady_lines, without_lines
from vehgen.diagnose.fits.base_anew import base_anew
from vehgen.diagnose.fits.begun_again import is_strained
from vehgen.diagnose.fits.model_fit import ModelFit, fit_base, mean_square_as_filed, narrow
from vehgen.diagnose.thresholds import NOISE_FLOOR
from vehgen.errors import InputError
from vehgen.fit.band import DIAGNOSIS_BAND_HZ, compared_band
from vehgen.fit.chain_estimate import slowest_rate
from vehgen.fit.misfit import Noises
from vehgen.fit.problem import Problem, make_problem
from vehgen.fit.recorders import CLEAR_RECORDER, MOST_LEFT, FoundRecorder, clearest, find_recorder, has_unknown
from vehgen.fit.trial import Trial

Array = NDArray[np.float64]
DETECTION_ROUNDS = 3
"""So often at most are the roads' part of the noise and an unknown recorder found, each from the fit with those before."""
BELIEVED_SIGMAS, FREE_SIGMAS = 2.5, 20.0
"""Errors of so many standard deviations need no explanation; up to so many they may be as large as they will."""
BAND_EDGES_HZ = (0.0, 3.0, 8.0, 15.0, np.inf)
"""Bands of the table of gaps [Hz]: rigid-body motion, between, wheel hop, above."""


@dataclass(frozen=True, eq=False)
class Detection:
    """What the first stage finds: the noise floor and how far the base model is above it.

    `base` is recalibrated. `recorder` stands for recorders that no run file declares; `numerical` is what
    the simulation's own error may add to the mean square of every run; `asked_band` the band that was asked for.
    """

    problem: Problem
    validation_runs: tuple[Trial, ...]
    floor: NoiseFloor
    base: ModelFit
    band: tuple[float, float] = DIAGNOSIS_BAND_HZ
    recorder: FoundRecorder | None = None
    numerical: dict[str, float] = field(default_factory=dict)
    asked_band: tuple[float, float] = DIAGNOSIS_BAND_HZ

    @property
    def nothing_missing(self) -> float:
        """The chi at or below which nothing is missing: that of the noise floor and of the simulation's own error together.

        What the simulation of one run may err by does not excuse what another run shows.
        """
        counts = {name: self.base.counts[name] for name in self.numerical}
        excused = {name: min(self.numerical[name], max(self.base.mean_squares[name] - 1, 0.0)) for name in counts}
        added = sum(excused[name] * count for name, count in counts.items()) / max(sum(counts.values()), 1)
        return float(np.sqrt(NOISE_FLOOR**2 + added))

    @cached_property
    def as_filed(self) -> tuple[float, float]:
        """The mean squares of the file's parameters, on training and validation runs (not a number where there are none)."""
        parts = (self.problem.trials, self.validation_runs)
        found = [mean_square_as_filed(part, self.floor.noises, self.band) for part in parts]
        return found[0], found[1]

    @property
    def is_quiet(self) -> bool:
        """Whether nothing is missing, on all runs and on the training runs."""
        return max(self.chi, float(np.sqrt(self.base.training))) <= self.nothing_missing

    @property
    def chi(self) -> float:
        """The base model's chi over all runs."""
        return self.base.chi

    @property
    def trials(self) -> tuple[Trial, ...]:
        """All runs, those for fitting first."""
        return (*self.problem.trials, *self.validation_runs)


@dataclass(frozen=True)
class BandGap:
    """chi of one run and channel within a band [Hz]."""

    run: str
    channel: str
    band: tuple[float, float]
    chi: float


def detect(trials: Sequence[Trial], band: tuple[float, float] | None = None) -> Detection:
    """Find the noise floor, recalibrate the base model on the training runs, measure the gap in a band [Hz] (default: that of the runs)."""
    _refuse_copies(trials)
    training, validation_runs = split_runs(trials)
    band = band or compared_band(trials)
    floor = find_noise_floor(trials, band)
    problem = narrow(make_problem(training))
    base = _fitted(problem, validation_runs, floor.noises, band)
    if lines := steady_lines(base):  # they were taken for noise
        problem, validation_runs = problem.with_trials(without_lines(training, lines)), list(without_lines(validation_runs, lines))
        floor = find_noise_floor((*problem.trials, *validation_runs), band)
        base = fit_base(problem, validation_runs, floor.noises, band, base)
    recorder: FoundRecorder | None = None
    unknown, profiles = has_unknown(trials), any(measured_profiles(trial) for trial in trials)
    for number in range(DETECTION_ROUNDS):
        floor = replace(floor, noises=_noises(base, floor))
        base = fit_base(problem, validation_runs, floor.noises, band if recorder is None else recorder.band, base)
        if not unknown and (number or not profiles):
            break
        if not unknown:
            continue
        found = find_recorder(base.least_squares.misfit, base.least_squares.x, None if recorder is None else recorder.channels, band)
        if recorder is not None and found.is_like(recorder):
            break
        recorders = found.with_usual(slowest_rate(trials))
        tried = [_recorded(item, problem, validation_runs, floor.noises, base) for item in recorders]
        which = clearest(recorders, [refit.squares for _, _, refit in tried])
        before, recorder = recorder, recorders[which]
        problem, validation_runs, base = tried[which]
        if before is not None and recorder.is_like(before):
            break
    if recorder is not None and (other := _rival(recorder, problem, validation_runs, floor.noises, base, band)):
        recorder, (problem, validation_runs, base) = other
    base = base_anew(base, validation_runs, floor.noises, base.least_squares.misfit.band)  # another recorder or noise may mislead it again
    return _with_telling_runs(_detection(problem, validation_runs, floor, base, recorder, band))


def _fitted(
    problem: Problem, validation_runs: Sequence[Trial], noises: Noises, band: tuple[float, float], begin: ModelFit | None = None
) -> ModelFit:
    """Return the base fitted, and fitted anew where that ended in a wrong minimum."""
    return base_anew(fit_base(problem, validation_runs, noises, band, begin), validation_runs, noises, band)


def _recorded(
    recorder: FoundRecorder, problem: Problem, validation_runs: Sequence[Trial], noises: Noises, base: ModelFit | None
) -> tuple[Problem, list[Trial], ModelFit]:
    """Return the problem and the validation runs through a recorder, and the base fitted to them."""
    problem, validation_runs = problem.with_trials(recorder.applied(problem.trials)), recorder.applied(validation_runs)
    return problem, validation_runs, fit_base(problem, validation_runs, noises, recorder.band, base)


def _rival(
    recorder: FoundRecorder, problem: Problem, validation_runs: Sequence[Trial], noises: Noises, base: ModelFit, band: tuple[float, float]
) -> tuple[FoundRecorder, tuple[Problem, list[Trial], ModelFit]] | None:
    """Return another low-pass with a base begun anew, where the base has bent to what it takes off; None where it has not."""
    rivals = (item for item in recorder.nearly_as_good() if not item.is_usual(slowest_rate(problem.trials)))
    if not is_strained(base.least_squares) or (rival := next(rivals, None)) is None:
        return None
    anew = _recorded(rival, problem, validation_runs, noises, None)
    if anew[2].squares > base.squares - CLEAR_RECORDER or anew[2].training > MOST_LEFT:
        return None
    fit = anew[2].least_squares
    found = find_recorder(fit.misfit, fit.x, recorder.channels, band)
    return (found, _recorded(found, *anew[:2], noises, anew[2])) if found.is_like(rival) else (rival, anew)


def look_again(detection: Detection, fit: ModelFit) -> Detection | None:
    """Return a detection whose recorder and errors of profiles follow from a better model's fit; None where they stay as they are.

    A missing effect passes in part for a rough profile, and for a low-pass of the recorder, however clear that one seems without it. What
    roughness makes of a law that is missing is not what it makes of the base.
    """
    recorder, floor = detection.recorder, detection.floor
    problem, validation_runs = detection.problem, list(detection.validation_runs)
    if recorder is not None:
        found = find_recorder(fit.least_squares.misfit, fit.least_squares.x, recorder.channels, detection.asked_band)
        if not found.is_like(recorder) and found.is_usual(slowest_rate(detection.trials)):
            recorder = found
            problem = problem.with_trials(found.applied(problem.trials))
            validation_runs = found.applied(validation_runs)
    noises = _noises(fit, floor)
    if recorder is detection.recorder and are_same_noises(noises, floor.noises, fit):
        return None
    band = detection.asked_band if recorder is None else recorder.band
    floor = replace(floor, noises=noises)
    base = _fitted(problem, validation_runs, noises, band, detection.base)
    return _with_telling_runs(_detection(problem, validation_runs, floor, base, recorder, detection.asked_band))


def supposing(detection: Detection, most_sigmas: float) -> Detection:
    """Return a detection whose base supposes errors of runs and sensors of so many standard deviations at most."""
    base = fit_base(
        detection.problem, detection.validation_runs, detection.floor.noises, detection.band, detection.base, most_sigmas=most_sigmas
    )
    return _detection(detection.problem, detection.validation_runs, detection.floor, base, detection.recorder, detection.asked_band)


def with_usual_recorder(detection: Detection) -> Detection | None:
    """Return a detection with the usual low-pass that leaves least, not a rare one or each sensor's own; None where it has one."""
    recorder, rate = detection.recorder, slowest_rate(detection.trials)
    if recorder is None or (not recorder.apart and recorder.is_usual(rate)):
        return None
    runs, noises = list(detection.validation_runs), detection.floor.noises
    usual = [item for item in replace(recorder, apart=()).with_usual(rate) if item.is_usual(rate)]
    tried = [(*_recorded(item, detection.problem, runs, noises, detection.base), item) for item in usual]
    problem, runs, base, one = min(tried, key=lambda item: item[2].squares)
    return _detection(problem, runs, detection.floor, base, one, detection.asked_band)


def _with_telling_runs(detection: Detection) -> Detection:
    """Return a detection with other validation runs where its own cannot show what is missing."""
    other = split_by_gap(detection.base, detection.trials)
    return detection if other is None else with_runs(detection, *other)


def with_runs(detection: Detection, training: Sequence[Trial], validation_runs: Sequence[Trial]) -> Detection:
    """Return a detection with other training and validation runs."""
    problem = detection.problem.with_trials(training)
    base = _fitted(problem, validation_runs, detection.floor.noises, detection.band)
    return _detection(problem, validation_runs, detection.floor, base, detection.recorder, detection.asked_band)


def _noises(fit: ModelFit, floor: NoiseFloor) -> Noises:
    """Return the noise of all runs with what a model's fit says of their roads, and of what roads make of its laws."""
    return rig_noises(fit, noises_of_laws(fit, road_noises(fit, floor.noises, floor.quiet)), floor.quiet)


def _detection(
    problem: Problem,
    validation_runs: Sequence[Trial],
    floor: NoiseFloor,
    base: ModelFit,
    recorder: FoundRecorder | None,
    asked_band: tuple[float, float],
) -> Detection:
    band = base.least_squares.misfit.band
    numerical = {name: value for part in base.parts for name, value in numerical_floor(part.misfit, part.x).items()}
    return Detection(problem, tuple(validation_runs), floor, base, band, recorder, numerical, asked_band)


def band_gaps(detection: Detection, fit: ModelFit | None = None) -> list[BandGap]:
    """Return chi by run, channel and band, of the base or of another fit."""
    fit = fit or detection.base
    found = []
    for trial in detection.trials:
        power = fit.spectra.get(trial.name)
        if power is None:
            continue
        n, dt = len(trial.recording.time), trial.recording.dt
        frequency = np.fft.rfftfreq(n, dt)
        frequency = frequency[(frequency >= detection.band[0]) & (frequency <= detection.band[1])]
        for low, high in pairwise(BAND_EDGES_HZ):
            inside = (frequency >= low) & (frequency < high)
            if inside.any():
                bounds = (max(low, detection.band[0]), min(high, detection.band[1]))
                chis = np.sqrt(power[inside].mean(axis=0))
                found += [BandGap(trial.name, name, bounds, float(chi)) for name, chi in zip(trial.channels, chis, strict=True)]
    return found


def _refuse_copies(trials: Sequence[Trial]) -> None:
    """Raise InputError where two runs hold the same recording: a copy is no check."""
    known: dict[bytes, str] = {}
    for trial in trials:
        content = trial.recording.values.tobytes()
        if content in known:
            raise InputError(
                f"{known[content]} and {trial.name} hold the same recording; a copy can neither teach nor check: leave one out"
            )
        known[content] = trial.name


@dataclass(frozen=True)
class RunGap:
    """How large a run's gap is beside its amplitude and speed.

    `height` of its highest hump [m] (0 without one), `speed` [m/s] (0 of a rig), `chi`, and `share`, the gap's root mean square over that
    of the recording, both in units of the noise: a linear cause keeps the share over amplitudes, a stop's grows, friction's falls.
    """

    run: str
    height: float
    speed: float
    chi: float
    share: float


def run_gaps(detection: Detection) -> list[RunGap]:
    """Return how large the base model's gap is in every run."""
    found = []
    for trial in detection.trials:
        sigma = detection.floor.noises[trial.name].sigma
        loudness = float(np.sqrt(np.mean((trial.recording.values / sigma) ** 2)))
        square = detection.base.mean_squares[trial.name]
        share = float(np.sqrt(max(square - 1.0, 0.0))) / loudness
        speed = trial.scenario.top_speed if trial.run.vehicle.axles else 0.0
        found.append(RunGap(trial.name, hump_height(trial), speed, float(np.sqrt(square)), share))
    return found
