"""Fits of the base and of what is added to it, on the training runs, judged on validation runs."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import partial

import numpy as np
from numpy.typing import NDArray

from vehgen.diagnose.fits.candidate import Candidate
from vehgen.fit.adjustments import Adjustment
from vehgen.fit.alignment import MOST_SIGMAS
from vehgen.fit.least_squares import COARSE_TOLERANCE, WEAK_PRIOR_SIGMA, FitOptions, LeastSquaresFit, fit_least_squares
from vehgen.fit.linearisation import Linearisation
from vehgen.fit.misfit import Misfit, Noises
from vehgen.fit.nuisances import Nuisances
from vehgen.fit.problem import Problem
from vehgen.fit.resolution import as_fine, resolve
from vehgen.fit.space import SearchSpace
from vehgen.fit.trial import Trial
from vehgen.simulate import SimulatorPool

Array = NDArray[np.float64]
NUISANCES = Nuisances(roll_off=0.0, edge=0.0, dispersion=0.0, edge_dispersion=0.0)
"""What runs and sensors may not know of themselves."""
BASE_RANGE = 0.3
"""The base may move its parameters by this share of a logarithm about the file's values: looser, it absorbs the effect."""
BASE_PRIOR_SIGMA = 0.17
"""Standard deviation of a base parameter in the unit cube: 0.1 of a logarithm."""
JACOBIAN_REFRESH = 5
"""The derivatives by nuisances serve for so many steps of a fit: saves two thirds of the time."""
DIAGNOSIS_TOLERANCE = 1e-6
"""Relative change of the sum of squares at which a fit of a diagnosis ends."""
OPTIONS = FitOptions(NUISANCES, tolerance=DIAGNOSIS_TOLERANCE, jacobian_refresh=JACOBIAN_REFRESH)
"""How a diagnosis fits."""
MUCH_WORSE = 1.5
"""Validation runs that leave so many times what noise or training runs do were perhaps fitted from wrong errors."""


@dataclass(frozen=True)
class ModelFit:
    """A fitted model: the base with `effects`; `training` and `validation` are mean squares of whitened residuals (1 is noise alone).

    `mean_squares` are those run by run, training runs first; `counts` how many residuals stand behind each; `spectra` the squares line by
    line and channel by channel, `shape (n_lines, n_channels)`; `validation_fit` the misfit and nuisances of the validation runs.
    `equivalent_minima` are the unknowns of other minima that do as well, where the response jumps.
    """

    effects: tuple[Candidate, ...]
    least_squares: LeastSquaresFit
    training: float
    validation: float
    mean_squares: dict[str, float]
    counts: dict[str, int]
    spectra: dict[str, Array]
    validation_fit: LeastSquaresFit | None = None
    equivalent_minima: tuple[Array, ...] = ()

    @property
    def label(self) -> str:
        """Its name in words."""
        return " and ".join(item.label for item in self.effects) or "base"

    @property
    def key(self) -> tuple[tuple[str, str], ...]:
        """Its effects by name and place."""
        return tuple((item.effect.name, item.place) for item in self.effects)

    @property
    def last(self) -> Candidate:
        """The effect added last."""
        return self.effects[-1]

    @property
    def n_effect_parameters(self) -> int:
        """How many of the searched parameters are the effects'."""
        return sum(len(item.parameters) for item in self.effects)

    @property
    def parts(self) -> tuple[LeastSquaresFit, ...]:
        """The fit to the training runs and, where there are any, that to the validation runs."""
        return (self.least_squares,) if self.validation_fit is None else (self.least_squares, self.validation_fit)

    @property
    def n_residuals(self) -> int:
        """How many residuals the training runs have."""
        return sum(self.counts[trial.name] for trial in self.least_squares.misfit.problem.trials)

    @property
    def squares(self) -> float:
        """-2 ln of the likelihood on the training runs and of the errors that it supposes, less a constant."""
        errors = self.least_squares.misfit.split(self.least_squares.x)[1]
        return self.training * self.n_residuals + float(errors @ errors)

    @property
    def chi(self) -> float:
        """Its chi over all runs."""
        return float(np.sqrt(_pooled(self.mean_squares, self.counts)))


@dataclass(frozen=True)
class CurrentModel:
    """What candidates are added to: the base or what has been found so far.

    `problem` begins at that fit's parameters, of which the last `free` are the effects'; `shared` are its adjustments, whose neutral
    numbers are the fitted ones; `unit` and `errors` are where parameters and errors begin; `training` is the mean square it leaves;
    `nearby` the last linearisation of the fit, `squares` the lines' frequencies [Hz] and squares, run by run; `validation_fits` the fit, if
    there is one, to the validation runs.
    """

    effects: tuple[Candidate, ...]
    problem: Problem
    shared: tuple[Adjustment, ...]
    n_effect_parameters: int
    unit: Array
    errors: Array
    training: float
    nearby: Linearisation | None = None
    squares: tuple[tuple[Array, Array], ...] = ()
    validation_fits: tuple[LeastSquaresFit, ...] = ()

    def slow(self, top: float) -> float:
        """Return the mean square that it leaves of motions up to a frequency [Hz]."""
        inside = [lines[frequency <= top].ravel() for frequency, lines in self.squares]
        return float(np.mean(np.concatenate(inside)))

    @classmethod
    def of(cls, fit: ModelFit) -> CurrentModel:
        """Return a fit as what further effects are added to."""
        misfit = fit.least_squares.misfit
        free = fit.n_effect_parameters
        unit, errors = misfit.split(fit.least_squares.x)
        numbers = misfit.adjusted(fit.least_squares.x)
        shared = tuple(replace(item, neutral=float(value)) for item, value in zip(misfit.shared, numbers, strict=True))
        space = misfit.problem.space
        if free:
            start = np.concatenate([space.start[: space.size - free], fit.least_squares.values[space.size - free :]])
            space = replace(space, start=start)
        nearby = fit.least_squares.linearisation
        squares = tuple((misfit.frequency(t), fit.spectra[trial.name]) for t, trial in enumerate(misfit.problem.trials))
        problem = Problem(misfit.problem.trials, space)
        return cls(fit.effects, problem, shared, free, unit, errors, fit.training, nearby, squares, fit.parts[1:])


def narrow(problem: Problem) -> Problem:
    """Return the problem with its space cut to BOUND about the file's values."""
    space = problem.space
    reach = np.maximum(np.abs(space.start) * (np.exp(BASE_RANGE) - 1), 0.02 * (space.upper - space.lower))
    positive = space.lower > 0
    low = np.where(positive, np.maximum(space.lower, space.start * np.exp(-BASE_RANGE)), np.maximum(space.lower, space.start - reach))
    high = np.where(positive, np.minimum(space.upper, space.start * np.exp(BASE_RANGE)), np.minimum(space.upper, space.start + reach))
    return Problem(problem.trials, SearchSpace(space.names, low, high, space.start))


def fit_base(
    problem: Problem,
    validation_runs: Sequence[Trial],
    noises: Noises,
    band: tuple[float, float],
    begin: ModelFit | None = None,
    most_sigmas: float = MOST_SIGMAS,
) -> ModelFit:
    """Fit the base model, from another fit of it or from the file's values, with errors of at most so many standard deviations."""
    options = replace(OPTIONS, band=band, prior_sigma=BASE_PRIOR_SIGMA, most_sigmas=most_sigmas)
    if begin is None:
        problem = resolve(*_begin(problem, noises, band))
        fit = fit_least_squares(problem, problem.space.unit(problem.space.start), options, noises=noises)
    else:
        old = begin.least_squares
        unit, errors = old.misfit.split(old.x)
        steps = {trial.name: trial for trial in old.misfit.problem.trials}
        resolved = problem.with_trials([as_fine(trial, steps[trial.name]) for trial in problem.trials])
        fit = fit_least_squares(resolved, unit, options, noises=noises, start=errors, nearby=old.linearisation)
    return evaluate_fit((), fit, validation_runs, noises, most_sigmas)


def mean_square_as_filed(trials: Sequence[Trial], noises: Noises, band: tuple[float, float]) -> float:
    """Return the mean square that the model as its file has it leaves: only each run's clock, speed and road height are fitted."""
    if not trials:
        return float("nan")
    problem = resolve(*_begin(Problem(tuple(trials), _nothing()), noises, band))
    options = replace(OPTIONS, band=band, tolerance=COARSE_TOLERANCE)
    fit = fit_least_squares(problem, np.zeros(0), options, noises=noises)
    return _pooled(*_by_run(_powers(fit)))


def base_priors(names: Sequence[str], effects: Sequence[Candidate]) -> Array:
    """Return the standard deviations, in the unit cube, of the priors of the base parameters `names`: weak for what effects set free."""
    freed = {name for item in effects for name in item.freed}
    return np.array([WEAK_PRIOR_SIGMA if name in freed else BASE_PRIOR_SIGMA for name in names])


def refine(
    problem: Problem,
    fit: LeastSquaresFit,
    x: Array,
    effects: Sequence[Candidate],
    noises: Noises | None = None,
    band: tuple[float, float] | None = None,
    known_errors: Sequence[LeastSquaresFit] = (),
    most_sigmas: float = MOST_SIGMAS,
    tolerance: float = DIAGNOSIS_TOLERANCE,
) -> LeastSquaresFit:
    """Fit finely from the unknowns `x` of another fit, on a problem with the same unknowns, of which the last are the effects'.

    With its noise and band, or with other ones, and errors of `most_sigmas` standard deviations at most; it ends at a relative change of
    the sum of squares of `tolerance`. Where the runs are others, `known_errors` are fits that tell where their errors begin.
    """
    misfit = fit.misfit
    n_effect_parameters = sum(len(item.parameters) for item in effects)
    names = problem.space.names[: problem.space.size - n_effect_parameters]
    unit, errors = misfit.split(x)
    options = replace(OPTIONS, band=band or misfit.band, max_steps=40, tolerance=tolerance, n_effect_parameters=n_effect_parameters)
    options = replace(options, prior_sigma=base_priors(names, effects), most_sigmas=most_sigmas)
    numbers = tuple(misfit.adjusted(x))
    return fit_least_squares(
        problem,
        unit,
        options,
        noises=noises or misfit.noises,
        start=partial(_errors_as_in, known_errors) if known_errors else errors,
        shared=misfit.shared,
        numbers=numbers,
        known=misfit.known,
        nearby=None if noises else fit.linearisation,
    )


def _errors_as_in(fits: Sequence[LeastSquaresFit], misfit: Misfit) -> Array:
    """Return the errors of a misfit as fits to parts of its runs have them, `shape (n_errors,)`."""
    return np.asarray(np.sum([misfit.errors_like(item.misfit, item.x) for item in fits], axis=0))


def evaluate_fit(
    effects: tuple[Candidate, ...],
    fit: LeastSquaresFit,
    validation_runs: Sequence[Trial],
    noises: Noises,
    most_sigmas: float = MOST_SIGMAS,
    near: Sequence[LeastSquaresFit] = (),
) -> ModelFit:
    """Simulate a fitted model on validation runs, of which only the clock, speed and road height are fitted, and the phase of a line.

    These errors begin as other models' fits to the same runs, `near`, have them (default: runs are laid over their recordings). Where that
    leaves MUCH_WORSE, runs are laid over their recordings after all: a model that lacks an effect may have lost a run's phase.
    """
    powers = _powers(fit)
    runs, counts = _by_run(powers)
    train, later = _pooled(runs, counts), float("nan")
    again: LeastSquaresFit | None = None
    if validation_runs:
        problem = fit.misfit.problem
        vehicle, fixed = problem.trials[0].run.vehicle, problem.best_values(fit.values)
        shared = SimulatorPool()
        for trial in problem.trials:
            shared.add(vehicle, [channel.output for channel in trial.recording.channels], trial.run.forces(), trial.simulator)
        trials = [trial.with_vehicle(vehicle, shared) for trial in validation_runs]
        own_values = (t.values | {k: v for k, v in fixed.items() if k not in t.fixed} for t in trials)
        frozen = Problem(tuple(replace(t, values=values) for t, values in zip(trials, own_values, strict=True)), _nothing())
        numbers = zip(fit.misfit.shared, fit.misfit.adjusted(fit.x), strict=True)
        frozen_shared = tuple(replace(item, neutral=float(at), scale=0.0) for item, at in numbers)
        frozen = resolve(*_begin(frozen, noises, fit.misfit.band, frozen_shared))
        options = replace(OPTIONS, band=fit.misfit.band, most_sigmas=most_sigmas)
        known = fit.misfit.common_errors(fit.x)
        check = partial(fit_least_squares, frozen, np.zeros(0), options, noises=noises, shared=frozen_shared, known=known)
        again = check(start=partial(_errors_as_in, near) if near else None)
        if near and again.chi2 > MUCH_WORSE * max(train, 1.0):
            again = min(again, check(), key=lambda item: item.loss)
        checked = _powers(again)
        own, own_counts = _by_run(checked)
        later, runs, counts, powers = _pooled(own, own_counts), runs | own, counts | own_counts, powers | checked
    return ModelFit(effects, fit, train, later, runs, counts, powers, again)


def _begin(problem: Problem, noises: Noises, band: tuple[float, float], shared: Sequence[Adjustment] = ()) -> tuple[Misfit, Array]:
    """Return a problem's misfit and unknowns where its space begins, with neutral adjustments and nuisances."""
    misfit = Misfit(problem, noises, problem.space.start, NUISANCES, band, shared)
    unit = problem.space.unit(problem.space.start)
    return misfit, np.concatenate([unit, np.zeros(misfit.n_unknowns - len(unit))])


def _nothing() -> SearchSpace:
    return SearchSpace((), np.zeros(0), np.zeros(0), np.zeros(0))


def _powers(fit: LeastSquaresFit) -> dict[str, Array]:
    """Return the squares of a fit's whitened lines by run, `shape (n_lines, n_channels)`."""
    lines = fit.misfit.whitened_spectrum(fit.x)
    return {trial.name: np.abs(item) ** 2 for trial, item in zip(fit.misfit.problem.trials, lines, strict=True)}


def _by_run(powers: dict[str, Array]) -> tuple[dict[str, float], dict[str, int]]:
    return {name: float(item.mean()) for name, item in powers.items()}, {name: 2 * item.size for name, item in powers.items()}


def _pooled(runs: dict[str, float], counts: dict[str, int]) -> float:
    total = sum(counts[name] for name in runs)
    return sum(runs[name] * counts[name] for name in runs) / total
