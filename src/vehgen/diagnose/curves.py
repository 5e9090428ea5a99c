"""Curves that a diagnosis shows: residuals before and after, and the loudest run measured beside simulated."""

from __future__ import annotations

import numpy as np

from vehgen.diagnose.result import DiagnosisModels
from vehgen.files.result_fields import rounded
from vehgen.fit.trial import Trial
from vehgen.measure import record_psd
from vehgen.measure.curves import ChannelCurves


def residual_curves(models: DiagnosisModels) -> tuple[tuple[ChannelCurves, ...], tuple[ChannelCurves, ...]]:
    """Return PSDs and histories of the residual before and after, of the loudest validation run's channels; none without an effect."""
    old, new = models.detection.base.validation_fit, models.chosen[-1].validation_fit if models.chosen else None
    if old is None or new is None:
        return (), ()
    trials = old.misfit.problem.trials
    loudest = _loudest(trials)
    trial = trials[loudest]
    before, after = (fit.misfit.recorded(loudest) - fit.misfit.simulate(fit.x)[loudest] for fit in (old, new))
    psds, histories = [], []
    for i, channel in enumerate(trial.recording.channels):
        frequency, earlier = record_psd(before[:, i], trial.recording.dt)
        later = record_psd(after[:, i], trial.recording.dt)[1]
        name = trial.name, channel.name, channel.quantity
        psds.append(ChannelCurves(*name, rounded(frequency, 7), rounded(earlier), rounded(later)))
        histories.append(ChannelCurves(*name, rounded(trial.recording.time, 7), rounded(before[:, i]), rounded(after[:, i])))
    return tuple(psds), tuple(histories)


def _loudest(trials: tuple[Trial, ...]) -> int:
    """Return the number of the loudest hump run, or of the loudest run where there is no hump."""
    humps = [any(entry.hump is not None for entry in trial.run.file.road) for trial in trials]
    return max(range(len(trials)), key=lambda t: (humps[t], float(np.mean(trials[t].recording.values ** 2))))


def response_curves(models: DiagnosisModels) -> tuple[ChannelCurves, ...]:
    """Return histories of the loudest run (of those for validation), as measured, and as the last model has it, shifted by roughness."""
    last = models.last
    fit = last.validation_fit or last.least_squares
    trials = fit.misfit.problem.trials
    loudest = _loudest(trials)
    trial = trials[loudest]
    simulated = fit.misfit.simulate(fit.x)[loudest] + trial.recording.values - fit.misfit.recorded(loudest)
    time = rounded(trial.recording.time, 7)
    return tuple(
        ChannelCurves(trial.name, channel.name, channel.quantity, time, rounded(trial.recording.values[:, i]), rounded(simulated[:, i]))
        for i, channel in enumerate(trial.recording.channels)
    )
