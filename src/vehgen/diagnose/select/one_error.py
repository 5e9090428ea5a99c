"""One error of the measurement in place of many: a speed, a gain, a clock that alone explains what the base has to bend many for."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from vehgen.diagnose import thresholds as limit
from vehgen.diagnose.detect.detection import BELIEVED_SIGMAS, Detection
from vehgen.diagnose.fits.candidate import Candidate
from vehgen.diagnose.fits.model_fit import ModelFit, evaluate_fit, refine
from vehgen.diagnose.inputs.conditions import BEYOND
from vehgen.diagnose.inputs.judging import supposed_mistakes
from vehgen.diagnose.result import Decided
from vehgen.diagnose.select.criteria import is_told
from vehgen.diagnose.select.fitter import Fitter
from vehgen.diagnose.select.ranking import SearchRound, merit, price_of_numbers
from vehgen.effects import RunEffect
from vehgen.effects.evidence import StartingPoint
from vehgen.fit.parallel import HERE, Runner

SUPPOSED_AS = {"speed_error": "speed", "sensor_delay": "clock", "sensor_gain": "gain"}
"""What a base supposes of each run, or of a sensor, by the name of the error that says it of all runs."""


def price_of_belief(strained: ModelFit, believed: ModelFit) -> float:
    """Return by how much -2 ln of the likelihood, of all runs and of the errors supposed, rises where errors are to be believed."""
    return _squares_of_all_runs(believed) - _squares_of_all_runs(strained)


def _squares_of_all_runs(fit: ModelFit) -> float:
    errors = [part.misfit.split(part.x)[1] for part in fit.parts]
    return sum(fit.mean_squares[run] * count for run, count in fit.counts.items()) + sum(float(item @ item) for item in errors)


def believable_law(fits: Sequence[ModelFit], strained: ModelFit) -> ModelFit | None:
    """Return the likeliest law of the vehicle that explains the training runs far better than a strained base; None where there is none.

    It supposes no error of a run or a sensor beyond BELIEVED_SIGMAS. A tyre that damps more than it should was taken for humps 12 % lower
    than stated and a sensor that reads 4 % less.

    Parameters
    ----------
    fits
        Of one effect each, the likeliest first, by the noise of the strained base.
    strained
        A base that supposes more of runs and sensors than can be believed.
    """
    laws = (fit for fit in fits if fit.last.effect.changes_vehicle and strained.squares - merit(fit) >= limit.FAINT_FALL)
    return next((fit for fit in laws if all(abs(item.sigmas) <= BELIEVED_SIGMAS for item in fit.least_squares.conditions())), None)


def explains_easily(found: Decided) -> bool:
    """Return whether effects of the vehicle were found, and beside them no error of a run or a sensor is beyond belief."""
    chain = found.models.chosen
    of_vehicle = bool(chain) and all(item.effect.changes_vehicle for item in chain[-1].effects)
    return of_vehicle and all(abs(item.sigmas) <= BEYOND for item in chain[-1].least_squares.conditions())


def one_error(
    strained: Detection, believed: Detection, found: Decided | None, candidates: Sequence[Candidate], runner: Runner = HERE
) -> SearchRound:
    """Try each error of all runs, or of a sensor, alone; return those that explain the runs, the likeliest first.

    None is tried where effects of the vehicle explain them, or Ctrl-C ended the search for these.

    One that does leaves noise, with all other errors of BELIEVED_SIGMAS at most and nothing to be supposed of the runs. It is likelier,
    with the price of its number, than the many errors of the strained base, and the runs tell its size. Fits begin where the believable
    base ends, all motions at once; if none explains the runs so, slow motions first; at last where the strained base ends, as the
    believable one may have lost the runs' phase.

    Parameters
    ----------
    strained
        Its base explains the runs, but supposes more of them than can be believed.
    believed
        The same with a base that supposes no more, and explains them far worse.
    found
        What the search for effects beside that base found; None where it left no gap to be searched.
    candidates
        Every effect at every place; those of the vehicle are passed over.
    runner
        Where they are fitted.
    """
    current = believed.base
    nothing = SearchRound(current, (), (), (), (), found is not None and found.stopped)
    if found is not None and (found.stopped or explains_easily(found)):
        return nothing
    alone = [item for item in candidates if isinstance(item.effect, RunEffect)]
    fitter = Fitter(believed, current, ())
    gains = fitter.first_order_gains()
    fits: list[ModelFit] = []
    try:
        for tried in (
            fitter.fit_all_begun([(item, gains.of(item)[1]) for item in alone], runner),
            fitter.fit_all(alone, runner),
            (fitter.fit_from(item, *begin) for item in alone if (begin := taken_over(strained.base, item)) is not None),
        ):
            within = (_within_belief(fit, believed) for fit in tried if fit is not None)
            fits = [fit for fit in within if _explains(fit, strained, believed)]
            if fits:
                break
    except KeyboardInterrupt:
        return replace(nothing, stopped=True)
    return replace(nothing, fits=tuple(sorted(fits, key=merit)))


def taken_over(strained: ModelFit, candidate: Candidate) -> tuple[StartingPoint, tuple[float]] | None:
    """Return where a fit begins with an error of all runs that takes over what a base supposes of each of them, in the mean.

    Returned are the base's parameters and errors, these less that mean, and the error's number; None where the base knows no such error.
    """
    fit = strained.least_squares
    conditions, place = fit.conditions(), "" if candidate.effect.is_global else candidate.place
    alike = np.array([(item.name, item.place) == (SUPPOSED_AS.get(candidate.effect.name), place) for item in conditions])
    if not isinstance(candidate.effect, RunEffect) or not alike.any():
        return None
    mean = float(np.mean([item.value for item, taken in zip(conditions, alike, strict=True) if taken]))
    unit, errors = fit.misfit.split(fit.x)
    left = errors - alike * mean / np.array([item.sigma for item in conditions])
    return (unit, left), (candidate.effect.neutral + mean,)


def _within_belief(fit: ModelFit, believed: Detection) -> ModelFit:
    """Return a fit with errors of BELIEVED_SIGMAS at most: refined, where they are larger."""
    supposed = [abs(item.sigmas) for part in fit.parts for item in part.conditions()]
    if not np.isfinite(fit.validation) or max(supposed, default=0.0) <= BELIEVED_SIGMAS:
        return fit
    old, noises = fit.least_squares, believed.floor.noises
    found = refine(old.misfit.problem, old, old.x, fit.effects, most_sigmas=BELIEVED_SIGMAS)
    return evaluate_fit(fit.effects, found, believed.validation_runs, noises, BELIEVED_SIGMAS)


def _explains(fit: ModelFit, strained: Detection, believed: Detection) -> bool:
    """Return whether an error alone explains the runs, and is likelier than the many of the strained base.

    By the whole likelihood: gains that a base supposes make its noise louder or quieter, so that squares over it do not compare.
    """
    return fit.least_squares.loss + price_of_numbers(fit) < strained.base.least_squares.loss and leaves_noise(fit, believed)


def leaves_noise(fit: ModelFit, detection: Detection) -> bool:
    """Return whether a fit leaves noise of all runs, with nothing to be supposed of them, and these tell its number."""
    with_it = replace(detection, base=fit)
    return bool(np.isfinite(fit.validation)) and with_it.is_quiet and not supposed_mistakes(with_it) and is_told(fit)
