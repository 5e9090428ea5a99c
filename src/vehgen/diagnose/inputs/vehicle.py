"""A vehicle that is not the file's: other parameters, where the base fit hangs on its bounds, or recordings of something else."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from vehgen.diagnose.fits.model_fit import BASE_RANGE
from vehgen.diagnose.inputs.fault import Hypothesis, MeasurementFault, always
from vehgen.diagnose.inputs.refits import LEAST_RUNS, BaseRefits
from vehgen.fit.least_squares import LeastSquaresFit
from vehgen.fit.problem import make_problem
from vehgen.fit.trial import Trial
from vehgen.fit.window import transform

OTHER = 0.004
"""The same for parameters beyond BASE_RANGE, unless the noise floor is reached: of honest effects relaxation comes nearest (0.017)."""
UNRELATED_SHARE = 0.6
"""Share of the energy that a stranger's recordings leave unexplained in every run; a wrong speed, an honest effect, leaves 0.52."""
SUSPECTS = 2
"""So many runs that the base fits worst may be of another vehicle."""
OWN_STARTS, OWN_REACH = 8, 0.3
"""So many more starts of a run's own vehicle, each parameter up to this share of its range from the file's."""
FEW = 2
"""So few parameters far off may stand for what the model lacks there."""
STRANGE = 0.1
"""Largest share of the excess that the other runs may leave without it."""


def strange_run_hypotheses(case: BaseRefits) -> Iterator[Hypothesis]:
    """Yield that one run is of another vehicle: without it the base fits the others, and with parameters of its own it fits that run."""
    if len(case.trials) < LEAST_RUNS:
        return
    together = case.refit(case.problem)[0]
    squares = [float(np.mean(np.abs(lines) ** 2)) for lines in together.misfit.whitened_spectrum(together.x)]
    for number in np.argsort(squares)[::-1][:SUSPECTS].tolist():
        trial = case.trials[number]
        blind = frozenset((trial.name, channel) for channel in trial.channels)
        hypothesis = Hypothesis(case.trials, always(strange_run(trial.name)), STRANGE, blind=blind)
        if case.judge(hypothesis)[1] <= STRANGE and _has_own_vehicle(case, trial, together):
            yield hypothesis


def _has_own_vehicle(case: BaseRefits, trial: Trial, together: LeastSquaresFit) -> bool:
    """Return whether parameters of its own explain a run: begun at the file's, at those that fit all runs, or at others about the file's.

    Over a long road the file's may be too far off: the fit then ends at a profile of no height. Another vehicle may be too far from both.
    """
    wide = make_problem((trial,))
    known = dict(zip(together.misfit.problem.space.names, together.values, strict=True))
    near = [known.get(name, value) for name, value in zip(wide.space.names, wide.space.start, strict=True)]
    filed = np.asarray(wide.space.unit(wide.space.start))
    drawn = filed + np.random.default_rng(0).uniform(-OWN_REACH, OWN_REACH, (OWN_STARTS, len(filed)))
    starts = [filed, np.asarray(wide.space.unit(np.asarray(near))), *np.clip(drawn, 0.0, 1.0)]
    enough = max(OTHER, case.noise)
    return any(case.refit(wide, unit=unit)[1] <= enough for unit in starts)


def strange_run(run: str) -> MeasurementFault:
    """Return that one run is of another vehicle than the others."""
    message = f"{run} does not go with the other runs: a vehicle fits them, and another one, of the same make, fits {run}"
    cure = "check that it is a run of this vehicle, loaded as in the other runs; else leave it out, or state its parameters with `set`"
    return MeasurementFault("other_vehicle", (run,), (), message, cure)


def other_vehicle(case: BaseRefits) -> tuple[MeasurementFault, ...]:
    """Return that the vehicle has other parameters than the file says, where these explain the gap."""
    if not case.base.on_bound:
        return ()
    wide = replace(make_problem(case.detected), trials=case.trials)
    fit, left = case.refit(wide, unit=np.asarray(wide.space.unit(case.base.values)))
    if left > max(OTHER, case.noise):
        return ()
    ratios = {
        name: value / start
        for name, value, start in zip(wide.space.names, fit.values, wide.space.start, strict=True)
        if min(value, start) > 0
    }
    far = sorted((name for name, ratio in ratios.items() if abs(np.log(ratio)) > BASE_RANGE), key=lambda name: -abs(np.log(ratios[name])))
    if not far:
        return ()
    listed = ", ".join(f"{name} {ratios[name]:.2f} times" for name in far[:4])
    message = (
        f"the recordings are of a vehicle with other parameters than the file's ({listed} its value): that alone explains "
        f"{100 * (1 - left):.0f} % of the gap"
    )
    if len(far) <= FEW:
        message += "; something unknown that acts as they do in these runs would look the same"
    return (MeasurementFault("other_parameters", (), (), message, "check the vehicle file, or calibrate first"),)


def unrelated_recording(fit: LeastSquaresFit) -> tuple[MeasurementFault, ...]:
    """Return that the recordings have nothing to do with the fitted model, where it explains too little of every run's energy."""
    misfit, shares = fit.misfit, []
    for t, (trial, (lines, _)) in enumerate(zip(misfit.problem.trials, misfit.residual_spectrum(fit.x), strict=True)):
        inside = np.isin(np.fft.rfftfreq(len(trial.recording.time), trial.recording.dt), misfit.frequency(t))
        recorded = transform(trial.recording.values, trial.recording.dt, inside, seen=trial.window)
        each = (np.abs(lines) ** 2).sum(axis=0) / (np.abs(recorded) ** 2).sum(axis=0)
        shares.append(float(np.median(each)))  # one channel alone that is wrong makes no stranger
    if min(shares) < UNRELATED_SHARE:
        return ()
    message = f"the recalibrated model leaves {100 * min(shares):.0f} % or more of every run unexplained"
    cure = "check that vehicle, road, speed and places of the sensors are those of these recordings"
    return (MeasurementFault("stranger", (), (), message, cure),)
