"""A calibration in one call: vehicle and runs in, all that they tell of the parameters out."""

from __future__ import annotations

import itertools
import os
import warnings
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from vehgen.calibrate.calibration import CalibrationProgress, Settings, calibrate_problem
from vehgen.calibrate.genetic import GeneticSearch
from vehgen.calibrate.intervals import check_combination
from vehgen.calibrate.result import CalibrationSummary
from vehgen.calibrate.summary import summarise
from vehgen.errors import ArgumentError, ModelWarning, did_you_mean
from vehgen.files.limits import check_count, check_seed, check_share
from vehgen.fit.band import CALIBRATION_BAND_HZ
from vehgen.fit.nuisances import asked_nuisances
from vehgen.fit.parallel import one_blas_thread, runner_at
from vehgen.fit.prior_data import load_prior_data
from vehgen.fit.problem import Problem, make_problem
from vehgen.fit.trial import TrialLike, load_trials
from vehgen.vehicle import VehicleLike, as_vehicle

POPULATIONS = {"ga": 1, "mpga": 3}
"""Kinds of genetic search, with the number of populations that exchange their best."""


def calibrate(
    vehicle: VehicleLike,
    runs: TrialLike | Sequence[TrialLike],
    *,
    method: str = "joint",
    sensors: Sequence[str] = (),
    freeze: Sequence[str] = (),
    search: str | None = None,
    size: int = 100,
    generations: int = 300,
    starts: int = 6,
    polish: bool = True,
    seed: int = 1,
    band: tuple[float, float] = CALIBRATION_BAND_HZ,
    height_error: float | None = None,
    speed_error: float | None = None,
    facts: str | os.PathLike[str] | None = None,
    combinations: Sequence[str] = (),
    bootstrap: int = 0,
    scheduler: str | None = None,
    workers: int = 1,
    checkpoint: str | os.PathLike[str] | None = None,
    resume: bool = False,
    progress: CalibrationProgress | None = None,
) -> CalibrationSummary:
    """Calibrate a vehicle's parameters from what its sensors recorded over a hump.

    Parameters
    ----------
    vehicle
        Whose `range`s say what to search: itself, its file, or the name of a bundled model.
    runs
        Runs with recordings: their files, runs, or trials.
    method
        `joint` (all sensors at once), `dhcm` (two sensors, two steps), or `shcm` (one sensor).
    sensors
        Those to use, in order (default: all of the runs).
    freeze
        For dhcm: the parameters kept from the first step (default: the nearest axle's).
    search
        `ga`, one population, or `mpga`, three that exchange their best (default: `ga` for shcm, else `mpga`).
    size, generations
        Individuals of a population; generations of a search, fewer where it settles before a polish.
    starts, polish
        Starts of the gradient polish; without polish the search's best stands, without intervals.
    seed
        Of all random numbers.
    band
        Frequencies compared [Hz].
    height_error, speed_error
        Relative uncertainty of the hump's height and of the speed (default: what each run file states, else 0.03 and 0.01).
    facts
        A file of axle weights and other facts known from elsewhere.
    combinations
        Expressions of the vehicle's parameters to estimate too, such as `k1/(mT + mS)`.
    bootstrap
        So many refits to redrawn noise check the intervals (0 leaves them out).
    scheduler
        Address of a Dask cluster for polish and bootstrap (default: this machine).
    workers
        So many processes of this machine polish and refit, where that takes long. More than one needs `if __name__ == "__main__":` around a
        script's work.
    checkpoint, resume
        A file that holds the search's state; go on from it.
    progress
        Called with what is done, how many of how many, and the best objective so far.

    Returns
    -------
    The summary; after Ctrl-C that of the best so far, its `stopped` set.

    Raises
    ------
    InputError
        For arguments and files that cannot be used.
    """
    check_numbers(size, generations, starts, bootstrap, seed, height_error, speed_error, band)
    settings = Settings(
        method=method,
        sensors=_names(sensors, "sensors"),
        frozen=_names(freeze, "freeze"),
        search=GeneticSearch(_populations(search, method), size, generations),
        seed=seed,
        polish=polish,
        starts=max(1, starts),
        band=(float(band[0]), float(band[1])),
        nuisances=asked_nuisances(speed=speed_error, height=height_error),
    )
    problem = make_problem(load_trials(runs, as_vehicle(vehicle)))
    _check_passes(problem)
    prior_data = None if facts is None else load_prior_data(Path(facts), problem)
    path = None if checkpoint is None else Path(checkpoint)
    asked = _names(combinations, "combinations")
    for text in asked:  # before the search, not after it
        check_combination(problem, text)
    with runner_at(scheduler, workers) as runner, one_blas_thread():  # small matrices: more threads only wait
        found = calibrate_problem(problem, settings, prior_data, progress, path, resume, runner)
        if prior_data is not None and polish and not found.stopped:
            for text in prior_data.missed(found.array):
                warnings.warn(ModelWarning(text), stacklevel=2)
        return summarise(found, prior_data, asked, 0 if found.stopped else bootstrap, runner)


def _check_passes(problem: Problem) -> None:
    """Refuse a recording that is given twice: intervals would be too narrow."""
    for one, other in itertools.combinations(problem.trials, 2):
        if one.channels == other.channels and np.array_equal(one.recording.values, other.recording.values):
            raise ArgumentError(f"`runs`: {one.name} and {other.name} are one recording; leave one of them out", "runs")


def check_numbers(
    size: int,
    generations: int,
    starts: int,
    bootstrap: int,
    seed: int,
    height_error: float | None,
    speed_error: float | None,
    band: tuple[float, float],
) -> None:
    """Refuse numbers that no search can use, before anything is read or made."""
    check_seed(seed, "seed")
    check_count(size, "size", 2, 100_000)
    check_count(generations, "generations", 0, 1_000_000)
    check_count(starts, "starts", 0, 10_000)
    check_count(bootstrap, "bootstrap", 0, 100_000)
    for value, name in ((height_error, "height_error"), (speed_error, "speed_error")):
        if value is not None:
            check_share(value, name)
    if len(band) != 2 or not 0 < band[0] < band[1]:
        raise ArgumentError(f"`band`: two frequencies in Hz were expected, the lower first and above 0; found {tuple(band)}", "band")


def _populations(search: str | None, method: str) -> int:
    kind = search or ("ga" if method == "shcm" else "mpga")
    if kind not in POPULATIONS:
        raise ArgumentError(f"`search`: no search {kind!r}; {did_you_mean(kind, POPULATIONS)}", "search")
    return POPULATIONS[kind]


def _names(names: Sequence[str], argument: str) -> tuple[str, ...]:
    """Return names as they are; a single text would be taken for one-letter names."""
    if isinstance(names, str):
        raise ArgumentError(f"`{argument}`: a list was expected, e.g. [{names!r}]", argument)
    return tuple(names)
