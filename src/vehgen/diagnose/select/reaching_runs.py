"""Runs that reach where no other does: a stop that only a validation run meets cannot be fitted without it."""

from __future__ import annotations

import numpy as np

from vehgen.diagnose import thresholds as limit
from vehgen.diagnose.detect.detection import Detection, with_runs
from vehgen.diagnose.fits.model_fit import ModelFit
from vehgen.diagnose.select.criteria import excess


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
    explained = excess(best.training) <= limit.NOISE_FLOOR**2 - 1 < excess(base.training)
    failed = np.isfinite(best.validation) and excess(best.validation) > limit.LAW_PASSES * excess(base.validation)
    if not (explained and failed and len(detection.problem.trials) > 1):
        return None
    reaching = max(detection.validation_runs, key=lambda trial: best.mean_squares[trial.name])
    checking = max(detection.problem.trials, key=lambda trial: base.mean_squares[trial.name])
    training = [reaching if trial is checking else trial for trial in detection.problem.trials]
    return with_runs(detection, training, [checking if trial is reaching else trial for trial in detection.validation_runs])
