"""Where to put how many sensors: by the Fisher information that each place adds.

Candidate places stand along every body; each measures acceleration and pitch rate. The information of a set is the sum over its sensors of
J'J/sigma^2 of a run, J the derivatives of the channels by ln(parameter). Sets grow one sensor at a time, each time by the place that most
reduces the mean variance of what can be told; every pair is tried as well, since two are often all there are.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations
from typing import ClassVar

import numpy as np
import scipy
from numpy.typing import NDArray

from vehgen.calibrate.identifiability import null_space, stacked_derivatives
from vehgen.calibrate.sensitivity import searched_parameters
from vehgen.files.limits import check_count
from vehgen.files.result_fields import Array1D
from vehgen.files.results import Cell, Result, Table
from vehgen.mechanics import derive
from vehgen.mechanics.outputs import Place, PointOutput
from vehgen.simulate import Run, RunLike, as_run, make_scenario
from vehgen.simulate.sensitivity import SensitivityProgress, direct_sensitivities
from vehgen.vehicle import VehicleLike

Array = NDArray[np.float64]
SIGMA = {"acceleration": 0.01, "pitch_rate": 5e-4}
"""A phone's noise floor [m/s^2, rad/s]."""
SHARE = 0.01
"""Noise as a share of a channel's RMS, added to the floor."""
PRIOR_SIGMA = 1.0
"""Standard deviation of ln(parameter) known beforehand: a factor of e either way, alike for all places."""
SPACING = 0.5
"""Distance between candidate places [m]."""
CLOSE_SHARE = 0.02
"""A place nearer than this [m] to its anchor is at it."""


@dataclass(frozen=True)
class SensorCandidate:
    """A place on a body: `distance` [m] behind an axle, hinge or body named `anchor`, `x` [m] ahead of the body's COG."""

    body: str
    anchor: str
    distance: float
    x: float

    @property
    def words(self) -> str:
        """The place in words."""
        if abs(self.distance) < CLOSE_SHARE:
            return f"on {self.body}, at {self.anchor}"
        return f"on {self.body}, {abs(self.distance):.2f} m {'behind' if self.distance > 0 else 'ahead of'} {self.anchor}"


@dataclass(frozen=True)
class Layout:
    """A set of places with what it leaves unknown.

    `error shape (n_parameters,)` are standard deviations of ln(parameter); `score` is their mean variance along the combinations that
    any sensor could tell, the smaller the better.
    """

    places: tuple[SensorCandidate, ...]
    error: Array1D
    score: float


@dataclass(frozen=True, eq=False)
class SensorAdvice(Result):
    """The best set of each size up to `len(best)`, and each candidate's own score, `single shape (n_candidates,)`."""

    KIND: ClassVar[str] = "sensor advice"
    DRAWING: ClassVar[str] = "vehgen.report.plots.result_plots:plot_sensor_advice"

    names: tuple[str, ...]
    best: tuple[Layout, ...]
    candidates: tuple[SensorCandidate, ...]
    single: Array1D

    def table(self) -> Table:
        """Return the best sets, a row each, with the mean and every parameter's standard deviation of ln(parameter)."""
        rows: list[tuple[Cell, ...]] = [
            (len(layout.places), "; ".join(place.words for place in layout.places), layout.score**0.5, *layout.error.tolist())
            for layout in self.best
        ]
        return ("sensors", "where", "mean error", *self.names), rows


def advise_sensors(
    run: RunLike,
    count: int = 3,
    *,
    parameters: Sequence[str] | None = None,
    vehicle: VehicleLike | None = None,
    progress: SensitivityProgress | None = None,
) -> SensorAdvice:
    """Return where to put 1, 2, ... `count` sensors on a run's vehicle.

    Parameters
    ----------
    run
        The run that would be measured, or its file: speed, hump and vehicle; its own sensors are ignored.
    count
        The largest number of sensors; no more than there are places.
    parameters
        Those that matter (default: all with a range).
    vehicle
        In place of the one that the run names: itself, its file, or the name of a bundled model.
    progress
        Is told of every piece of work its name, and how much of how much is done.

    Raises
    ------
    InputError
        For a number or parameters that cannot be used.
    """
    check_count(count, "count", 1, 100)
    run = as_run(run, vehicle)
    chosen = searched_parameters(run.vehicle, parameters)
    places = candidates(run)
    outputs, mixing = _channels(places)
    model = derive(run.vehicle, outputs)
    values = model.values(overrides=run.values())
    scenario = make_scenario(run, model, values)
    excitation = scenario.excitation(model.wheel_offsets(values))
    response, derived = direct_sensitivities(model, excitation, chosen, scenario.decimation, values, progress)
    response, derived = response @ mixing, derived @ mixing * np.abs([values[name] for name in chosen])[:, None, None]
    floor = np.tile(list(SIGMA.values()), len(places))
    white = derived / np.hypot(floor, SHARE * np.sqrt(np.mean(response**2, axis=0)))
    each = np.einsum("itc,jtc->cij", white, white, optimize=True)
    information = each.reshape(len(places), len(SIGMA), len(chosen), len(chosen)).sum(axis=1)
    null = null_space(stacked_derivatives(model, values, chosen) * np.abs([values[name] for name in chosen]))[0]
    basis = scipy.linalg.null_space(null) if len(null) else np.eye(len(chosen))
    best: list[Layout] = []
    taken: tuple[int, ...] = ()
    for size in range(1, min(count, len(places)) + 1):
        sets = list(combinations(range(len(places)), 2)) if size == 2 else [(*taken, i) for i in range(len(places)) if i not in taken]
        layouts = [_layout(places, information, basis, item) for item in sets]
        winner = int(np.argmin([item.score for item in layouts]))
        taken = sets[winner]
        best.append(layouts[winner])
        if progress is not None:
            progress("sets of sensors", size, min(count, len(places)))
    single = np.array([_layout(places, information, basis, (i,)).score for i in range(len(places))])
    return SensorAdvice(chosen, tuple(best), places, single)


def _layout(places: tuple[SensorCandidate, ...], information: Array, basis: Array, chosen: tuple[int, ...]) -> Layout:
    total = information[list(chosen)].sum(axis=0)
    covariance = np.linalg.inv(total + np.eye(len(total)) / PRIOR_SIGMA**2)
    score = float(np.trace(basis.T @ covariance @ basis) / basis.shape[1])
    return Layout(tuple(places[i] for i in chosen), np.sqrt(np.diag(covariance)), score)


def _channels(places: tuple[SensorCandidate, ...]) -> tuple[list[PointOutput], Array]:
    """Return channels at the anchors, and what mixes them into acceleration and pitch rate of every place.

    A point d behind another of the same rigid body rises by d times the (nose-down) pitch more.
    """
    outputs: list[PointOutput] = []
    index: dict[tuple[str, ...], int] = {}
    for place in places:
        for key, quantity in (
            ((place.body, place.anchor), "acceleration"),
            ((place.body, "pitch_acceleration"), "pitch_acceleration"),
            ((place.body, "pitch_rate"), "pitch_rate"),
        ):
            if key not in index:
                index[key] = len(outputs)
                name = f"p{len(outputs)}"
                outputs.append(PointOutput(name, Place(name, place.body, behind=place.anchor), quantity))
    mixing = np.zeros((len(outputs), 2 * len(places)))
    for i, place in enumerate(places):
        mixing[index[place.body, place.anchor], 2 * i] = 1.0
        mixing[index[place.body, "pitch_acceleration"], 2 * i] = place.distance
        mixing[index[place.body, "pitch_rate"], 2 * i + 1] = 1.0
    return outputs, mixing


def candidates(run: Run) -> tuple[SensorCandidate, ...]:
    """Return places every SPACING along each body that pitches, between its outermost axles and hinges; its COG otherwise."""
    model = derive(run.vehicle)
    values = model.values(overrides=run.values())
    vehicle = run.vehicle
    found: list[SensorCandidate] = []
    for body in vehicle.bodies:
        anchors = [name for name, axle in vehicle.axles.items() if axle.body == body]
        anchors += [name for name, hinge in vehicle.hinges.items() if body in hinge.points]
        distances = [model.layout.place(vehicle, name) - model.layout.bodies[body][0] for name in anchors]
        marks = dict(zip(anchors, model.evaluate_list(distances, values), strict=True))
        if len(marks) < 2 or "pitch" not in vehicle.bodies[body].motions:
            found.append(SensorCandidate(body, body, 0.0, 0.0))
            continue
        front, rear = max(marks.values()), min(marks.values())
        for x in np.linspace(front, rear, max(2, round((front - rear) / SPACING) + 1)):
            anchor = min(marks, key=lambda name: (abs(marks[name] - x), name))
            found.append(SensorCandidate(body, anchor, float(marks[anchor] - x), float(x)))
    return tuple(found)
