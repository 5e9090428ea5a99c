"""Check the intervals of a calibration: refit it to redrawn noise, and see how far its combinations and frequencies stray."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial

import numpy as np

from vehgen.calibrate.calibration import StepResult
from vehgen.calibrate.intervals import LEVEL, Estimate, Uncertainty, errors_left_open, refit
from vehgen.fit.parallel import Runner
from vehgen.fit.prior_data import PriorData


def bootstrap_intervals(
    result: StepResult,
    uncertainty: Uncertainty,
    facts: PriorData | None,
    ratios: Sequence[Estimate],
    replicates: int,
    seed: int,
    runner: Runner,
) -> list[Estimate]:
    """Return the bootstrap's intervals of combinations, then of the natural frequencies.

    Parameters
    ----------
    result
        A step of a calibration, fitted by least squares.
    uncertainty
        Of its best fit.
    facts
        What was known from elsewhere.
    ratios
        Combinations of parameters, named by their expression.
    replicates
        How many refits.
    seed
        Of the calibration.
    runner
        Where the refits run.
    """
    seeds = [int(item) for item in np.random.SeedSequence([seed, 3]).generate_state(replicates)]
    fit = result.fits[0]
    draw = partial(refit, fit, left_open=errors_left_open(fit), facts=facts)
    rows = np.array(list(runner.map(draw, seeds)))
    tail = 50 * (1 - LEVEL)
    found = []
    for estimate in ratios:
        spread = np.array([uncertainty.expression(estimate.name)(row) for row in rows])
        low, high = np.percentile(spread, [tail, 100 - tail])
        found.append(Estimate(estimate.name, estimate.value, float(low), float(high)))
    spread = np.array([uncertainty.mode_table(row)[0] for row in rows])
    for j, (hz, _) in enumerate(uncertainty.frequencies()):
        low, high = np.percentile(spread[:, j], [tail, 100 - tail])
        found.append(Estimate(f"{hz.name} [Hz]", hz.value, float(low), float(high)))
    return found
