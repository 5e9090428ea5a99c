"""Runs that change places: a stop that only a validation run meets cannot be fitted without it, nor one checked that it does not show."""

from __future__ import annotations

import numpy as np

from vehgen.diagnose import thresholds as limit
from vehgen.diagnose.detect.detection import Detection, with_runs
from vehgen.diagnose.fits.model_fit import ModelFit
from vehgen.diagnose.select.criteria import excess
from vehgen.fit.trial import Trial


def with_reaching_run(detection: Detection, best: ModelFit) -> Detection | None:
    """Return a detection that fits the validation run at which a law fails that leaves noise of all training runs; None without one.

    That run may go where the others do not: its stop is met there alone. It changes places with the training run that shows the largest
    gap, so that what is found is still checked on a run that shows it.

    Parameters
    ----------
    detection
        As it is.
    best
        The best effect's fit.
    """
    base = detection.base
    floor = limit.NOISE_FLOOR**2 - 1
    explained = excess(best.training) <= floor < excess(base.training)
    failed = np.isfinite(best.validation) and excess(best.validation) > max(limit.LAW_PASSES * excess(base.validation), floor)
    if not (explained and failed and len(detection.problem.trials) > 1):
        return None
    reaching = max(detection.validation_runs, key=lambda trial: best.mean_squares[trial.name])
    checking = max(detection.problem.trials, key=lambda trial: base.mean_squares[trial.name])
    return _exchanged(detection, reaching, checking)


def with_checking_run(detection: Detection, best: ModelFit) -> Detection | None:
    """Return a detection that keeps for validation the training run of which the best effect explains most; None with a single one.

    It changes places with the validation run of which that effect explains least.
    """
    if len(detection.problem.trials) < 2:
        return None

    def explained(trial: Trial) -> float:
        return (detection.base.mean_squares[trial.name] - best.mean_squares[trial.name]) * best.counts[trial.name]

    return _exchanged(detection, min(detection.validation_runs, key=explained), max(detection.problem.trials, key=explained))


def _exchanged(detection: Detection, held: Trial, fitted: Trial) -> Detection:
    """Return a detection whose validation run `held` is fitted, and whose training run `fitted` is kept for validation instead."""
    training = [held if trial is fitted else trial for trial in detection.problem.trials]
    return with_runs(detection, training, [fitted if trial is held else trial for trial in detection.validation_runs])
