"""Calibration from start to end: search, polish from several starts, and what was learnt; stoppable and resumable."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Callable, Iterator, Sequence
from dataclasses import asdict, dataclass, field, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from vehgen.calibrate.equivalents import nearest_equivalent
from vehgen.calibrate.genetic import GeneticSearch, SearchState
from vehgen.calibrate.methods import Step, plan
from vehgen.calibrate.objective import PsdObjective
from vehgen.calibrate.polish import Polish, PolishOptions, polish
from vehgen.errors import InputError
from vehgen.files import write_text
from vehgen.files.provenance import file_hashes
from vehgen.files.reading import read_text
from vehgen.files.tables import MAX_TABLE_BYTES
from vehgen.fit.band import CALIBRATION_BAND_HZ
from vehgen.fit.least_squares import LeastSquaresFit
from vehgen.fit.nuisances import Nuisances
from vehgen.fit.parallel import Runner
from vehgen.fit.prior_data import PriorData
from vehgen.fit.problem import Problem
from vehgen.fit.recorders import FoundRecorder
from vehgen.simulate.run_file.files_read import files_read

Array = NDArray[np.float64]
SAVE_EVERY = 10
"""Generations between two checkpoints."""
NEAR_START = 0.1
"""How far further starts of the polish stray from the search's best, in the unit cube."""


@dataclass(frozen=True)
class Settings:
    """How to calibrate; with the same settings and inputs the result is the same bit for bit."""

    method: str = "joint"
    sensors: tuple[str, ...] = ()
    frozen: tuple[str, ...] = ()
    search: GeneticSearch = field(default_factory=GeneticSearch)
    seed: int = 1
    polish: bool = True
    starts: int = 6
    band: tuple[float, float] = CALIBRATION_BAND_HZ
    nuisances: Nuisances = field(default_factory=Nuisances)


@dataclass(frozen=True)
class StepResult:
    """What one step found.

    `state` is the search's last state; `fits` the polished starts, best first (empty without polish); `problem` what was searched;
    `recorder` what the fits suppose of recorders that no run file declares.
    """

    step: Step
    problem: Problem
    state: SearchState
    fits: tuple[LeastSquaresFit, ...]
    recorder: FoundRecorder | None = None

    @property
    def values(self) -> dict[str, float]:
        """The step's best parameters by name [SI]."""
        best = self.fits[0].values if self.fits else self.problem.space.values(self.state.elite)
        return self.problem.best_values(best)


@dataclass(frozen=True)
class Calibration:
    """A finished or stopped calibration: the steps' results and the parameters they add up to [SI].

    `stopped` says that it was interrupted: the values are then the best so far.
    """

    problem: Problem
    settings: Settings
    steps: tuple[StepResult, ...]
    values: dict[str, float]
    stopped: bool = False

    @property
    def array(self) -> Array:
        """The parameters in the order of the problem's space, `shape (n_parameters,)` [SI]."""
        return np.array([self.values[name] for name in self.problem.space.names])


CalibrationProgress = Callable[[str, int, int, float], None]
"""Called with what is done, how many of how many, and the best objective so far."""


def calibrate_problem(
    problem: Problem,
    settings: Settings,
    prior_data: PriorData | None = None,
    progress: CalibrationProgress | None = None,
    checkpoint: Path | None = None,
    resume: bool = False,
    runner: Runner | None = None,
) -> Calibration:
    """Search, then polish, the parameters of a problem step by step.

    Parameters
    ----------
    problem, settings
        Trials and parameters; method, search and seed.
    prior_data
        What is known from elsewhere; it enters the polish.
    progress
        Told of every generation and every polished start.
    checkpoint, resume
        A file that holds the search's state, written every SAVE_EVERY generations and when stopped; and whether to go on from it, to
        the same result as if it had not been stopped.
    runner
        Where the polish's starts run (default: here, one after the other).

    Raises
    ------
    InputError
        For settings or a checkpoint that do not fit.
    """
    progress = progress or (lambda label, done, total, best: None)
    steps = plan(problem, settings.method, settings.sensors, settings.frozen)
    saved = _load(checkpoint, problem, settings) if resume else []
    values = dict(zip(problem.space.names, problem.space.start.tolist(), strict=True))
    results: list[StepResult] = []
    stopped = False
    for number, step in enumerate(steps):
        frozen = {name: value for name, value in values.items() if name not in step.searched}
        own = problem.of_sensors(step.sensors).searching(step.searched, frozen)
        objective = PsdObjective(own, settings.band)
        state: SearchState | None = None
        polished = Polish((), None)
        generations = settings.search.generations
        try:
            for state in _search(objective, settings, number, saved[number] if number < len(saved) else None):
                progress(step.label, state.generation, generations, state.elite_objective)
                if checkpoint is not None and (state.generation % SAVE_EVERY == 0 or _ends(settings, state)):
                    _save(checkpoint, problem, settings, [*(item.state for item in results), state])
            assert state is not None
            if settings.polish:
                polished = _polish_all(own, state, settings, prior_data, runner or Runner(), progress, step.label)
        except KeyboardInterrupt:
            if state is None:
                raise
            if checkpoint is not None:
                _save(checkpoint, problem, settings, [*(item.state for item in results), state])
            polished, stopped = Polish((), None), True
        results.append(StepResult(step, own, state, polished.fits, polished.recorder))
        values |= {name: value for name, value in results[-1].values.items() if name in step.kept}
        if stopped:
            break
        if polished.recorder is not None:
            problem = problem.with_trials(polished.recorder.applied(problem.trials))
    return Calibration(problem, settings, tuple(results), values, stopped)


def _search(objective: PsdObjective, settings: Settings, number: int, state: SearchState | None) -> Iterator[SearchState]:
    search = settings.search
    if state is None:
        state = search.start(objective, objective.problem.space.size, settings.seed + number, quick=objective.quick)
    yield state
    while not _ends(settings, state):
        state = search.advance(state, objective, objective.quick)
        yield state


def _ends(settings: Settings, state: SearchState) -> bool:
    """Return whether a search ends: a polish goes on from where it has settled."""
    return state.generation >= settings.search.generations or (settings.polish and state.is_settled)


def _polish_all(
    problem: Problem, state: SearchState, settings: Settings, facts: PriorData | None, runner: Runner, tell: CalibrationProgress, label: str
) -> Polish:
    own_facts = None if facts is None else replace(facts, problem=problem)
    points = starting_points(problem, state, settings)
    options = PolishOptions(settings.nuisances, settings.band, runner)
    found = polish(problem, points, options, own_facts, lambda done, best: tell(f"{label}, polish", done, len(points), best))
    best, *others = found.fits
    return replace(found, fits=(nearest_equivalent(best, own_facts), *others))


def starting_points(problem: Problem, state: SearchState, settings: Settings) -> list[Array]:
    """Return where the polish starts: the search's best, the vehicle file's values, each population's best, and points near the best."""
    random = np.random.Generator(np.random.PCG64([settings.seed, 2]))
    best = [genes[objective.argmin()] for genes, objective in zip(state.genes, state.objective, strict=True)]
    points: list[Array] = []
    for point in (state.elite, problem.space.unit(problem.space.start), *best):
        if not any(np.array_equal(point, other) for other in points):
            points.append(np.asarray(point))
    while len(points) < settings.starts:
        points.append(np.clip(state.elite + random.uniform(-NEAR_START, NEAR_START, problem.space.size), 0.0, 1.0))
    return points[: settings.starts]


def fingerprint(problem: Problem, settings: Settings) -> str:
    """Return a hash of everything the search depends on: settings, ranges, start values, measurements, and the files that were read."""
    digest = hashlib.sha256()
    told = asdict(replace(settings, polish=True, starts=0, nuisances=Nuisances(), search=replace(settings.search, generations=0)))
    digest.update(json.dumps(told, sort_keys=True).encode())
    digest.update(" ".join(problem.space.names).encode())
    for array in (problem.space.lower, problem.space.upper, problem.space.start):
        digest.update(array.tobytes())
    files = files_read([trial.run for trial in problem.trials])
    digest.update(" ".join(sorted(file_hashes(files).values())).encode())
    for trial in problem.trials:
        digest.update(trial.recording.values.tobytes())
        digest.update(trial.recording.time.tobytes())
        digest.update(json.dumps(trial.run.vehicle.document.plain(), sort_keys=True, default=str).encode())
        digest.update(json.dumps(trial.values, sort_keys=True).encode())
        digest.update(json.dumps(trial.run.document.plain(), sort_keys=True, default=str).encode())
    return digest.hexdigest()


def _save(path: Path, problem: Problem, settings: Settings, states: Sequence[SearchState]) -> None:
    data = {"fingerprint": fingerprint(problem, settings), "states": [state.to_data() for state in states]}
    write_text(path, json.dumps(data))


def _load(path: Path | None, problem: Problem, settings: Settings) -> list[SearchState]:
    if path is None or not path.is_file():
        raise InputError(f"there is no search to resume{'' if path is None else f' at {path}'}")
    try:
        data = json.loads(read_text(path, MAX_TABLE_BYTES, "a checkpoint of a calibration", state=True))
        found, states = data["fingerprint"], [SearchState.from_data(item) for item in data["states"]]
    except (ValueError, KeyError, TypeError, RecursionError) as error:
        raise InputError(f"{path} is not a checkpoint of a calibration: {error}") from error
    if found != fingerprint(problem, settings):
        raise InputError(f"{path} belongs to another calibration: vehicle, runs, method, seed and population size must be the same")
    return states
