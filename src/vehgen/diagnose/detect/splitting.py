"""Which runs are fitted, and which are kept to check what the fits find."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from vehgen.diagnose.fits.model_fit import ModelFit
from vehgen.diagnose.thresholds import WEAK
from vehgen.fit.trial import Trial

UNSHOWN = 0.1
"""Validation runs that show less than this share of the excess of the training runs show nothing, nor do training runs then, below ..."""
SHOWN_CLEARLY = 2.0
"""... this chi."""


def split_runs(trials: Sequence[Trial]) -> tuple[list[Trial], list[Trial]]:
    """Return training runs and validation runs: of three runs or more, every second one between the gentlest and the roughest."""
    ordered = sorted(trials, key=kind_of_run)
    held = ordered[1:-1:2]
    apart = {id(trial) for trial in held}
    return [trial for trial in ordered if id(trial) not in apart], held


def split_by_gap(base: ModelFit, trials: Sequence[Trial]) -> tuple[list[Trial], list[Trial]] | None:
    """Return other training and validation runs where those of a fit do not both show what is missing; None where they do, or none could.

    A part shows too little where its excess is less than UNSHOWN of the other's: a stop is met by the roughest run alone. Training runs
    with a chi of SHOWN_CLEARLY show enough. Then every second run by gap is a validation run, the clearest and the least clear ones aside.
    """
    before, shown = max(base.training - 1, 0.0), max(base.validation - 1, 0.0)
    telling = shown >= UNSHOWN * before and (before >= UNSHOWN * shown or base.training >= SHOWN_CLEARLY**2)
    if base.validation_fit is None or max(base.training, base.validation) <= WEAK**2 or telling:
        return None
    ordered = sorted(trials, key=lambda trial: base.mean_squares[trial.name])
    held = ordered[-2:0:-2]
    if np.mean([base.mean_squares[trial.name] for trial in held]) - 1 < UNSHOWN * before:
        return None
    apart = {trial.name for trial in held}
    return [trial for trial in trials if trial.name not in apart], held


def kind_of_run(trial: Trial) -> tuple[float, ...]:
    """Return what a run is like, whatever it is called: its humps' height, its speed, what was measured."""
    return (hump_height(trial), trial.scenario.top_speed, float(np.sort(trial.recording.values**2, axis=None).sum()))


def hump_height(trial: Trial) -> float:
    """Return the height of a run's highest hump [m], 0 without one."""
    return max((entry.hump.height or 0.0 for entry in trial.run.file.road if entry.hump is not None), default=0.0)
