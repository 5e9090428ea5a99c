"""The base fitted anew, slow motions first, where its fit is bad and strained: it may have locked in a whole cycle off.

A recalibrated base lies over its recordings from the start, and all motions are fitted at once. Where much is unknown of a run (a phone's
clock, an unsteady speed) it may end in a wrong minimum, with gains and heights at their bounds. What is missing is then looked for
beside a vehicle that is wrong for no reason.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from vehgen.diagnose import thresholds as limit
from vehgen.diagnose.fits.begun_again import is_strained
from vehgen.diagnose.fits.candidate import FREED_BASE, Candidate
from vehgen.diagnose.fits.model_fit import CurrentModel, ModelFit
from vehgen.diagnose.fits.multi_start import fit_candidate
from vehgen.effects import EffectLocator
from vehgen.fit.alignment import align
from vehgen.fit.misfit import Noises
from vehgen.fit.trial import Trial
from vehgen.simulate import SimulatorPool

NO_EFFECT = Candidate(FREED_BASE, "", ())


def base_anew(base: ModelFit, validation_runs: Sequence[Trial], noises: Noises, band: tuple[float, float]) -> ModelFit:
    """Return a base or, where it leaves more than noise with errors at their bounds, one fitted anew that leaves half of that at most."""
    on_road = any(trial.scenario.track.parts for trial in base.least_squares.misfit.problem.trials)
    if base.chi <= limit.NOISE_FLOOR or not on_road or not is_strained(base.least_squares):
        return base
    current, misfit = CurrentModel.of(base), base.least_squares.misfit
    trial, space = current.problem.trials[0], current.problem.space
    filed = space.unit(space.start)
    laid = align(misfit, filed, bands=())
    locator = EffectLocator(trial.run.vehicle, dict(trial.values))
    again = fit_candidate(
        NO_EFFECT, current, validation_runs, noises, band, locator, SimulatorPool(), [(filed, current.errors)], [()], laid, slow_first=True
    )
    return base if again is None or not np.isfinite(again.validation) or again.squares >= base.squares else replace(again, effects=())
