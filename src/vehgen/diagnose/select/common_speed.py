"""Runs that were all driven faster, or slower, than their files say: what is detected of them at the speeds that they suppose."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from vehgen.diagnose.detect.detection import Detection, detect, with_runs
from vehgen.effects.evidence import StartingPoint
from vehgen.fit.trial import Trial
from vehgen.road import SpeedLaw

MOST_LOOKS = 3
"""So often at most is the speed of all runs put right by what they still suppose: the errors of a run are bounded."""
SETTLED_SIGMAS = 0.5
"""What is left of it in the mean, in standard deviations of one run's, is each run's own."""


def at_common_speed(detection: Detection) -> tuple[Detection, tuple[StartingPoint, tuple[float]] | None]:
    """Return a detection whose recorder and noise are those of runs at the speeds that they suppose, and where a fit begins there.

    These are parameters and errors, and the number of `speed_error`. A base that cannot be as fast as its runs loses their phase, bends to
    it whatever it can, a recorder's low-pass too, and is held against the noise of roads that axles meet too late one after the other. No
    beginning is returned where runs show more than noise at other speeds, too.
    """
    stated = {trial.name: trial.scenario.speed for trial in detection.trials}
    unknown = detection.trials if detection.recorder is None else detection.recorder.forgotten(detection.trials)
    found, scale = detection, 1.0
    for _ in range(MOST_LOOKS):
        speeds = [item for part in found.base.parts for item in part.conditions() if item.name == "speed"]
        if found is not detection and abs(np.mean([item.sigmas for item in speeds])) < SETTLED_SIGMAS:
            break
        scale *= 1 + float(np.mean([item.value for item in speeds]))
        found = detect([_driven(trial, scale) for trial in unknown], detection.asked_band)
    if not found.is_quiet:
        return found, None
    training, validation = ([_at(stated[trial.name], trial) for trial in part] for part in (found.problem.trials, found.validation_runs))
    as_stated, fit = with_runs(found, training, validation), found.base.least_squares
    errors = as_stated.base.least_squares.misfit.errors_like(fit.misfit, fit.x)
    return as_stated, ((fit.misfit.split(fit.x)[0], errors), (scale,))


def _at(speed: SpeedLaw, trial: Trial) -> Trial:
    return replace(trial, scenario=replace(trial.scenario, speed=speed))


def _driven(trial: Trial, scale: float) -> Trial:
    """Return a trial at so many times its speed."""
    return replace(trial, scenario=trial.scenario.adjusted(speed=scale, anchor=trial.scenario.first_arrival))
