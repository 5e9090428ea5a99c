"""Would any law do? Random laws at the winner's place, with as many numbers as it has, that no physics stands behind.

A decoy is a sum of k random smooth functions of the place's travel d and rate v, sin(a d/sd + b v/sv + c) with normal a, b and uniform c,
whose k factors are least squares, with all that the base parameters and nuisances can do besides. Where one of many decoys does as well as
the named effect, the data do not ask for that effect.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from vehgen.diagnose import thresholds as limit
from vehgen.diagnose.fits.model_fit import ModelFit
from vehgen.diagnose.fits.projection import Projection
from vehgen.diagnose.localise.recovered_force import motions
from vehgen.diagnose.localise.unknown_force import PlaceResult
from vehgen.diagnose.select.ranking import SearchRound
from vehgen.fit.window import flatten, transform
from vehgen.simulate.frequency import force_response

Array = NDArray[np.float64]
COUNT = 40
SEED = 20240


def decoy_mean_squares(
    base: ModelFit, place: PlaceResult, motion: Mapping[str, tuple[Array, Array]], numbers: int, count: int = COUNT, seed: int = SEED
) -> Array:
    """Return the mean square on the training runs that each of `count` placebo laws leaves, `shape (count,)`.

    Parameters
    ----------
    base
        The fit that the effect was added to.
    place
        Where the effect acts, with the base parameters that the place test found.
    motion
        Travel [m] and rate [m/s] of the place by training run, each `shape (n,)`.
    numbers
        How many numbers a decoy may fit.
    """
    misfit = base.least_squares.misfit
    projection = Projection.of(misfit, place.x)
    left, size = projection.left, projection.size
    scales = [float(np.sqrt(np.mean(np.concatenate([item[i] for item in motion.values()]) ** 2))) for i in (0, 1)]
    responses = _responses(base, place)
    random = np.random.Generator(np.random.PCG64(seed))
    found = []
    for _ in range(count):
        columns = []
        for slope, rate, phase in zip(
            random.normal(size=numbers), random.normal(size=numbers), random.uniform(0, 2 * np.pi, numbers), strict=True
        ):
            parts = []
            for t, trial in enumerate(misfit.problem.trials):
                d, v = motion[trial.name]
                force = np.sin(slope * d / scales[0] + rate * v / scales[1] + phase) - np.sin(phase)
                frequency = np.fft.rfftfreq(len(d), trial.recording.dt)
                inside = (frequency >= misfit.band[0]) & (frequency <= misfit.band[1])
                lines = transform(force[:, None], trial.recording.dt, inside, seen=trial.window) * responses[t]
                parts.append(flatten(misfit.whiten(t, misfit.read_at(t, lines, place.x))))
            columns.append(np.concatenate(parts))
        own = projection.remainder(np.array(columns).T)
        remaining = left - own @ np.linalg.lstsq(own, left, rcond=None)[0]
        found.append(float(remaining @ remaining) / size)
    return np.array(found)


def _responses(base: ModelFit, place: PlaceResult) -> list[NDArray[np.complex128]]:
    misfit = base.least_squares.misfit
    values = misfit.problem.space.values(misfit.split(place.x)[0])
    known = [misfit.problem.values_of(values, trial) for trial in misfit.problem.trials]
    models = [trial.simulator.model for trial in misfit.problem.trials]
    number = models[0].element_number(place.place.kind, place.place.name)
    rows = place.place.rows[:1]
    return [force_response(model, known[t], rows, misfit.frequency(t), number)[:, :, 0] for t, model in enumerate(models)]


def left_by_placebo_laws(places: Sequence[PlaceResult], base: ModelFit, fit: ModelFit) -> Array | None:
    """Return the mean square on the training runs that each of COUNT decoys leaves at the place of a fit's last effect, `shape (COUNT,)`.

    None where that effect is no law at one of the `places` of a single force.
    """
    forces = [item for item in places if item.unknowns == 1 and item.place.kind != "body" and item.place.rows]
    here = [item for item in forces if item.place.name == fit.last.place]
    place = next((item for item in here if item.place.kind == fit.last.effect.attaches), here[0] if here else None)
    if place is None or not fit.last.effect.changes_vehicle:
        return None
    return decoy_mean_squares(base, place, motions(base.least_squares.misfit, place), max(len(fit.last.parameters), 1))


def compare_with_placebo_laws(found: SearchRound, fit: ModelFit) -> tuple[float, float] | None:
    """Return the shares of the excess on the training runs that an effect and the best decoy close.

    None where the effect is no law at the place that the place test found with one force.
    """
    left = left_by_placebo_laws(found.passed, found.current, fit)
    if left is None:
        return None
    before = max(found.current.training - 1, 1e-9)
    return 1 - max(fit.training - 1, 0.0) / before, 1 - max(float(left.min()) - 1, 0.0) / before


def like_a_placebo_law(places: Sequence[PlaceResult], base: ModelFit, fit: ModelFit) -> bool:
    """Return whether the best decoy lets the squares fall as far as an effect does, but for DECOY of that."""
    left = left_by_placebo_laws(places, base, fit)
    return left is not None and base.training - float(left.min()) >= (1 - limit.DECOY) * (base.training - fit.training)
