"""An error that all runs suppose alike: one error of all runs, and not as many that happen to agree."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from vehgen.diagnose.detect.detection import Detection, with_runs
from vehgen.diagnose.fits.candidate import Candidate
from vehgen.diagnose.fits.model_fit import ModelFit, evaluate_fit, refine
from vehgen.diagnose.inputs.conditions import ALIKE_SIGMAS, alike_conditions, far_together
from vehgen.diagnose.select.common_speed import at_common_speed
from vehgen.diagnose.select.estimates import fitted_numbers
from vehgen.diagnose.select.fitter import Fitter
from vehgen.diagnose.select.one_error import SUPPOSED_AS, leaves_noise, taken_over
from vehgen.diagnose.select.ranking import merit
from vehgen.effects.evidence import StartingPoint
from vehgen.files.quantities import Spread
from vehgen.fit.nuisances import Condition
from vehgen.fit.parallel import HERE
from vehgen.fit.trial import Trial
from vehgen.simulate.run_file.knowledge import UncertaintyEntry

AGREE_WITHIN = 0.25
"""From the least to the largest in so many standard deviations of what each run may be off by; that three are all off the same way, each by
one at least, and agree so, is a chance of one in 1000."""
OF_ONE_KIND = {"clock": ("clock",), "speed": ("speed", "wander")}
"""The errors that a run does not have where it supposes none of a kind: a driver who strays all the way drives another speed."""
BEFORE = "each run might have had such an error of its own, but all agree: chi before is that of runs without any"
"""What is told beside it."""


def one_cause(detection: Detection, candidates: Sequence[Candidate]) -> tuple[Detection, tuple[ModelFit, ...]] | None:
    """Return the error of a sensor's clock, or of all speeds, that explains what every run supposes, and the gap of runs that suppose none.

    It is followed by what no run tells from it: that another sensor's clock is as much off the other way.

    Clocks that are set run by run, and speeds that are read run by run, are off by as many different amounts. Where all agree, one cause
    made them, and no run needs an error of its own. Where all are off the same way, and far together, one number of all runs is likelier,
    with its price, and small errors of each beside it. None where such an error does not leave noise of all runs, or where the runs do
    not tell its size. What a base leaves that cannot be as fast as the runs were may look like more than noise.

    Parameters
    ----------
    detection
        A base, and what it supposes of the runs.
    candidates
        Every effect at every place.
    """
    conditions = [item for part in detection.base.parts for item in part.conditions()]
    runs = [trial.name for trial in detection.trials]
    for alike in alike_conditions(conditions, runs, np.inf, 0.0):
        candidate = next((item for item in candidates if _says(item, alike[0])), None)
        if candidate is None or not (_agree(alike) or far_together(alike)):
            continue
        speed = alike[0].name == "speed"
        found, begin = at_common_speed(detection) if speed else (detection, taken_over(detection.base, candidate))
        if begin is None:
            continue
        parts = found.problem.trials, found.validation_runs
        sure = with_runs(found, *([_sure_of(OF_ONE_KIND[alike[0].name], trial) for trial in part] for part in parts))
        fit = None if sure.is_quiet else _instead(sure, candidate, alike, begin[1]) or _beside(found, candidate, alike, begin)
        if fit is not None:
            return sure, (fit, *_other_way(sure, fit, candidates))
    return None


def _agree(alike: Sequence[Condition]) -> bool:
    """Return whether runs are all off by so much alike that one cause is as good as theirs."""
    sigmas = [item.sigmas for item in alike]
    return min(map(abs, sigmas)) >= ALIKE_SIGMAS and max(sigmas) - min(sigmas) <= AGREE_WITHIN


def _other_way(sure: Detection, fit: ModelFit, candidates: Sequence[Candidate]) -> list[ModelFit]:
    """Return fits of what no run tells from a fit, as its effect says, off as much the other way, where they leave noise, too."""
    last, (number,) = fit.last, fitted_numbers(fit, fit.last)
    others = [item for item in candidates if last.effect.tie_advice and item.effect.tie_advice == last.effect.tie_advice]
    begun = [(item, (-number,)) for item in others if item.place != last.place]
    return [other for other in Fitter(sure, sure.base, ()).fit_all_begun(begun, HERE) if leaves_noise(other, sure)]


def _instead(sure: Detection, candidate: Candidate, alike: Sequence[Condition], number: tuple[float]) -> ModelFit | None:
    """Return the fit of one error of all runs in place of theirs, where these agree."""
    if not _agree(alike):
        return None
    fit = Fitter(sure, sure.base, ()).fit_begun((candidate, number))
    return fit if fit is not None and leaves_noise(fit, sure) else None


def _beside(
    detection: Detection, candidate: Candidate, alike: Sequence[Condition], begin: tuple[StartingPoint, tuple[float]]
) -> ModelFit | None:
    """Return the fit of one error of all runs beside small ones of each, where it is likelier than theirs alone."""
    if not far_together(alike):
        return None
    rough = Fitter(detection, detection.base, ()).fit_from(candidate, *begin)
    if rough is None:
        return None
    old = rough.least_squares
    found = refine(old.misfit.problem, old, old.x, rough.effects)  # a fit beside a base that leaves noise stays rough
    fit = evaluate_fit(rough.effects, found, detection.validation_runs, detection.floor.noises)
    return fit if leaves_noise(fit, detection) and merit(fit) < detection.base.squares else None


def _says(candidate: Candidate, error: Condition) -> bool:
    """Return whether an effect says of all runs what an error says of one."""
    place = "" if candidate.effect.is_global else candidate.place
    return (SUPPOSED_AS.get(candidate.effect.name), place) == (error.name, error.place)


def _sure_of(names: Sequence[str], trial: Trial) -> Trial:
    """Return a trial whose run file states that it has none of these errors."""
    known = trial.run.file.uncertainty or UncertaintyEntry()
    stated = known.model_copy(update=dict.fromkeys(names, Spread(0.0, True)))
    return replace(trial, run=replace(trial.run, file=trial.run.file.model_copy(update={"uncertainty": stated})))
