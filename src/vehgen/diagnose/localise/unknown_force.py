"""The place test: where the model errs, before any law is guessed.

Hypothesis P says that an unknown force history acts at P (or that a channel cannot be used). At every spectral line the columns H_P(f),
what the sensors show per unit of that force, are projected out of the whitened residual, and the base parameters are refitted to what
remains (Gauss-Newton, with a prior). Where P is true, noise remains: chi is 1. Needs no law, and leaves base parameters that the effect
has not biased.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np
from numpy.typing import NDArray

from vehgen.fit.least_squares import unknown_bounds
from vehgen.fit.linearisation import Lineariser, linearise
from vehgen.fit.misfit import Misfit
from vehgen.fit.parallel import HERE, Runner
from vehgen.fit.window import flatten
from vehgen.mechanics.rows import Row
from vehgen.simulate.frequency import force_response

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]
GAUSS_NEWTON_STEPS = 7
LOG_PRIOR_SIGMA = 0.1
"""Standard deviation of ln(parameter) about the vehicle file's values."""
HIDDEN = 0.005
"""A direction of the unknowns is hidden by a hypothesis that leaves less than this share of what it moves, as a suspension's force hides
the suspension's own stiffness: what is left of it then is error, and the prior alone decides."""


@dataclass(frozen=True)
class Place:
    """A hypothesis: unknown forces at `rows` of the coordinates, or `channels` that cannot be used.

    `kind` is suspension, tyre, link, hinge, body or channel; `name` what it is called there.
    """

    kind: str
    name: str
    rows: tuple[Row, ...] = ()
    channels: tuple[str, ...] = ()

    @property
    def label(self) -> str:
        """Its name in words."""
        return f"{self.kind} {self.name}" if self.kind != "none" else "nowhere"


@dataclass(frozen=True)
class PlaceResult:
    """How well a hypothesis does: `chi` of what it leaves, `unknowns` a spectral line, and the base fit `x` it leaves."""

    place: Place
    chi: float
    unknowns: int
    x: Array


def list_places(misfit: Misfit) -> list[Place]:
    """Return every place of the vehicle at which an unknown force may act, every unusable channel and sensor, and none at all."""
    model = misfit.problem.trials[0].simulator.model
    places = [Place("none", "")]
    places += [Place(element.kind, element.name, (element.row,)) for element in model.elements]
    for body in model.vehicle.bodies:
        heave, pitch = model.motion.heave.get(body, {}), model.motion.pitch.get(body, {})
        if heave:
            places.append(Place("body", f"{body} (force at its COG)", (heave,)))
        if pitch:
            places.append(Place("body", f"{body} (pitch moment)", (pitch,)))
        if heave and pitch:
            places.append(Place("body", body, (heave, pitch)))
    names = list(dict.fromkeys(name for trial in misfit.problem.trials for name in trial.channels))
    places += [Place("channel", name, (), (name,)) for name in names]
    sensors: dict[str, list[str]] = {}
    for trial in misfit.problem.trials:
        for channel in trial.recording.channels:
            if channel.name not in sensors.setdefault(channel.sensor, []):
                sensors[channel.sensor].append(channel.name)
    places += [Place("sensor", name, (), tuple(members)) for name, members in sensors.items() if len(members) > 1]
    return places


def score_locations(
    misfit: Misfit, x: Array, places: Sequence[Place], derive: Lineariser | None = None, runner: Runner = HERE
) -> list[PlaceResult]:
    """Return each hypothesis with the chi it leaves.

    Parameters
    ----------
    misfit
        The base model's misfit, with the noise floor as its noise.
    x
        The base fit.
    places
        Hypotheses of :func:`list_places`.
    derive
        What linearises the misfit (default: anew at every point, by differences to both sides).
    runner
        Where the places are tested.
    """
    derive = derive or Lineariser(misfit)
    test = partial(_test, misfit, _Point.at(misfit, x, derive), derive)
    return [result for result in runner.map(test, places) if result is not None]


@dataclass(frozen=True, eq=False)
class _Point:
    """Unknowns `x shape (n_unknowns,)`, the whitened lines there, their derivatives, and W'W of all their lines."""

    x: Array
    lines: Sequence[Complex]
    derivatives: Sequence[Complex]
    squares: Array

    @classmethod
    def at(cls, misfit: Misfit, x: Array, derive: Lineariser) -> _Point:
        """Simulate and linearise a misfit at unknowns."""
        derivatives = derive(x).spectra
        whole = np.vstack([flatten(item, first=1).T for item in derivatives])
        return cls(x, misfit.whitened_spectrum(x), derivatives, whole.T @ whole)


def _test(misfit: Misfit, begin: _Point, derive: Lineariser, place: Place) -> PlaceResult | None:
    """Fit the unknowns to what a hypothesis cannot explain; None where it explains everything.

    Steps come from the normal equations, which the prior keeps well conditioned: the Jacobian is tall.
    """
    point, new, best, best_chi = begin, begin.x, begin.x, np.inf
    unknowns = 0
    for turn in range(GAUSS_NEWTON_STEPS):
        if turn:
            point = _Point.at(misfit, new, derive)
        x = point.x
        parts, slopes, count = [], [], 0
        for t, lines in enumerate(point.lines):
            basis = _basis(misfit, x, place, t)
            if basis is not None and basis.shape[2] >= lines.shape[1]:
                return None
            unknowns = max(unknowns, 0 if basis is None else basis.shape[2])
            parts.append(flatten(_project(lines, basis)))
            slopes.append(flatten(_project(point.derivatives[t], basis), first=1).T)
            count += 2 * lines.shape[0] * (lines.shape[1] - (0 if basis is None else basis.shape[2]))
        residual, jacobian = np.concatenate(parts), np.vstack(slopes)
        rows, offset = _prior(misfit, x)
        effective = min(misfit.n_unknowns, count - 1)
        chi = float(np.sqrt((residual @ residual) / (count - effective)))
        if chi < best_chi:
            best, best_chi = x, chi
        if not (np.isfinite(chi) and np.all(np.isfinite(jacobian))):  # the last step led to where the model diverges
            break
        squares, prior = jacobian.T @ jacobian, rows.T @ rows
        shown = _shown(squares, point.squares + prior)
        slope = shown.T @ (jacobian.T @ residual) + rows.T @ offset
        new = np.clip(x - np.linalg.solve(shown.T @ squares @ shown + prior, slope), *unknown_bounds(misfit))
        if np.abs(new - x).max() < 1e-4:
            break
    return PlaceResult(place, best_chi, unknowns, best)


def _shown(squares: Array, whole: Array) -> Array:
    """Return what takes the directions that a hypothesis hides out of its Jacobian J, times it from the right, `shape (n_unknowns,) * 2`.

    Hidden is that of which the hypothesis leaves too little: the eigenvectors of J'J v = share `whole` v with a share below HIDDEN, where
    `squares` is J'J and `whole` that of all lines and the prior, W'W + P'P.
    """
    factor = np.linalg.cholesky(whole)
    inverse = np.linalg.inv(factor)
    shares, directions = np.linalg.eigh(inverse @ squares @ inverse.T)
    hidden = directions[:, shares < HIDDEN]
    return np.asarray(np.eye(len(whole)) - inverse.T @ hidden @ hidden.T @ factor.T)


def posterior(misfit: Misfit, result: PlaceResult) -> Array:
    """Return the covariance of the base fit that a hypothesis leaves, `shape (n_unknowns, n_unknowns)`: Gauss-Newton, with the prior.

    What the hypothesis cannot see, as an element's own stiffness, is known no better than by the prior.
    """
    derivatives = linearise(misfit, result.x).spectra
    slopes = [flatten(_project(item, _basis(misfit, result.x, result.place, t)), first=1).T for t, item in enumerate(derivatives)]
    jacobian, whole = np.vstack(slopes), np.vstack([flatten(item, first=1).T for item in derivatives])
    rows, _ = _prior(misfit, result.x)
    squares, prior = jacobian.T @ jacobian, rows.T @ rows
    shown = _shown(squares, whole.T @ whole + prior)
    return np.asarray(np.linalg.inv(shown.T @ squares @ shown / max(result.chi, 1.0) ** 2 + prior))


def _prior(misfit: Misfit, x: Array) -> tuple[Array, Array]:
    """Return the prior's rows and residuals: parameters about the file's values, nuisances about nothing."""
    n, total = misfit.n_parameters, misfit.n_unknowns
    space = misfit.problem.space
    rows, offset = np.eye(total), x.copy()
    weight = np.abs(space.slopes(space.start)) / (LOG_PRIOR_SIGMA * np.maximum(np.abs(space.start), 1e-9))
    rows[:n] *= weight[:, None]
    offset[:n] = weight * (x[:n] - space.unit(space.start))
    return rows, offset


def _basis(misfit: Misfit, x: Array, place: Place, t: int) -> Complex | None:
    """Return an orthonormal basis of what the hypothesis may explain in trial t's whitened lines, `shape (n, n_channels, n_unknowns)`."""
    trial = misfit.problem.trials[t]
    frequency = misfit.frequency(t)
    if place.channels:
        columns = [trial.channels.index(name) for name in place.channels if name in trial.channels]
        if not columns:
            return None
        raw = np.zeros((len(frequency), len(trial.channels), len(columns)), dtype=np.complex128)
        for j, column in enumerate(columns):
            raw[:, column, j] = 1.0
    elif place.rows:
        known = misfit.problem.values_of(misfit.problem.space.values(misfit.split(x)[0]), trial)
        number = trial.simulator.model.element_number(place.kind, place.name)
        raw = force_response(trial.simulator.model, known, place.rows, frequency, number) * trial.channel_factors(frequency)[:, :, None]
    else:
        return None
    white = np.stack(
        [misfit.whiten(t, misfit.read_at(t, raw[:, :, j], x) if place.rows else raw[:, :, j]) for j in range(raw.shape[2])], axis=2
    )
    return np.asarray(np.linalg.qr(white)[0])


def _project(lines: Complex, basis: Complex | None) -> Complex:
    """Return lines `shape (..., n, n_channels)` without their part in the basis."""
    if basis is None:
        return lines
    inside = np.einsum("nck,...nc->...nk", basis.conj(), lines)
    return np.asarray(lines - np.einsum("nck,...nk->...nc", basis, inside))
