"""Natural modes: frequencies from K and M, damped ones from the state matrix, names from where their energy is."""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, ClassVar, overload

import numpy as np
from numpy.typing import NDArray

from vehgen.errors import InputError
from vehgen.files.result_fields import Array1D
from vehgen.files.results import Result, Table
from vehgen.mechanics.coordinates import Coordinate
from vehgen.mechanics.numeric_model import NumericModel
from vehgen.simulate.assignment import assign
from vehgen.simulate.mode_groups import scaled_to_peak, settled_shapes
from vehgen.simulate.remembered_equations import equations_as_data
from vehgen.vehicle import Vehicle, as_vehicle
from vehgen.vehicle.checks import complete_values

if TYPE_CHECKING:
    from vehgen.mechanics import ModelLike

Array = NDArray[np.float64]
_SHARED = 0.6


@dataclass(frozen=True)
class Mode:
    """A natural mode.

    `undamped_hz` solves det(K - (2 pi f)^2 M) = 0; `pole_hz` = |pole|/2 pi and `damping_ratio` = -Re/|pole| belong to the damped
    vehicle's pole whose shape is nearest; `shape shape (n_dof,)` has unit largest entry; `energy` is each coordinate's share of the
    kinetic energy.
    """

    name: str
    undamped_hz: float
    pole_hz: float
    damping_ratio: float
    shape: Array1D
    energy: Array1D

    @property
    def damped_hz(self) -> float:
        """The frequency at which the motion oscillates as it decays, |Im pole|/2 pi [Hz]; 0 where it does not oscillate."""
        return self.pole_hz * float(np.sqrt(max(1 - self.damping_ratio**2, 0.0)))


@dataclass(frozen=True, eq=False)
class Modes(Result, Sequence[Mode]):
    """All modes of a vehicle, by ascending undamped frequency: a sequence. `coordinates` name the entries of their shapes."""

    KIND: ClassVar[str] = "modes"
    DRAWING: ClassVar[str] = "vehgen.report.plots.result_plots:plot_modes"

    coordinates: tuple[str, ...]
    modes: tuple[Mode, ...]

    def __len__(self) -> int:
        return len(self.modes)

    @overload
    def __getitem__(self, index: int) -> Mode: ...
    @overload
    def __getitem__(self, index: slice) -> tuple[Mode, ...]: ...
    def __getitem__(self, index: int | slice) -> Mode | tuple[Mode, ...]:
        return self.modes[index]

    def __iter__(self) -> Iterator[Mode]:
        return iter(self.modes)

    def table(self) -> Table:
        """Return the modes, a row each."""
        columns = ("mode", "undamped [Hz]", "damped [Hz]", "damping ratio")
        return columns, [(mode.name, mode.undamped_hz, mode.damped_hz, mode.damping_ratio) for mode in self.modes]


def natural_modes(model: ModelLike, values: Mapping[str, float] | None = None, *, parameter_set: str | None = None) -> Modes:
    """Return all modes, by ascending undamped frequency; force laws are not in them.

    An overdamped pair of real poles -a, -b has `pole_hz` sqrt(a b)/2 pi and the damping ratio (a + b)/(2 sqrt(a b)) > 1.

    Parameters
    ----------
    model
        Equations of motion, or a vehicle: itself, its file, or the name of a bundled model.
    values
        Parameters [SI] by name; what is not named keeps the value of the set, or the file's.
    parameter_set
        One of the vehicle's sets.

    Raises
    ------
    InputError
        When M is not positive definite at these values, and as :func:`vehgen.mechanics.all_values`.
    """
    coordinates, numeric = _evaluated(model, values, parameter_set)
    try:
        squares, shapes = _undamped(numeric)
    except np.linalg.LinAlgError as error:
        raise InputError("the mass matrix is not positive definite: a motion has no inertia") from error
    shapes = settled_shapes(squares, shapes, numeric.M)
    damped = _match(_damped_pairs(numeric), numeric, shapes)
    shares = [_energy(numeric.M, shape) for shape in shapes.T]
    names = _names(coordinates, shares)
    modes = []
    for square, shape, share, name, (radius, ratio) in zip(squares, shapes.T, shares, names, damped, strict=True):
        frequency = float(np.sqrt(max(square, 0.0)) / (2 * np.pi))
        modes.append(Mode(name, frequency, radius / (2 * np.pi), ratio, scaled_to_peak(shape), share))
    return Modes(tuple(item.name for item in coordinates), tuple(modes))


def _evaluated(
    model: ModelLike, values: Mapping[str, float] | None, parameter_set: str | None
) -> tuple[tuple[Coordinate, ...], NumericModel]:
    """Return a model's coordinates and its matrices at values of its parameters; those of a vehicle need not be derived again."""
    if isinstance(model, Vehicle | str | os.PathLike):
        model = as_vehicle(model)
        plain = equations_as_data(model)
        if plain is not None:
            known = complete_values(model, plain.parameters, values, parameter_set, model.values)
            return plain.coordinates, plain.numeric(known)
    from vehgen.mechanics import all_values, as_model

    equations = as_model(model)
    return equations.coordinates, equations.numeric(all_values(equations, values, parameter_set))


def _undamped(numeric: NumericModel) -> tuple[Array, Array]:
    """Return the eigenvalues of K - lambda M, ascending, and vectors of unit modal mass; raises LinAlgError for M not positive definite."""
    lower = np.linalg.cholesky(numeric.M)
    scaled = np.linalg.solve(lower, np.linalg.solve(lower, numeric.K).T)
    squares, vectors = np.linalg.eigh((scaled + scaled.T) / 2)
    return squares, np.asarray(np.linalg.solve(lower.T, vectors), dtype=np.float64)


def _energy(M: Array, shape: Array) -> Array:
    """Return each coordinate's share of a mode's kinetic energy (cross terms split evenly, negative shares clipped)."""
    share = np.clip(shape * (M @ shape), 0.0, None)
    return np.asarray(share / share.sum(), dtype=np.float64)


def _damped_pairs(numeric: NumericModel) -> list[tuple[complex, complex, NDArray[np.complex128]]]:
    """Return the eigenvalue pairs of the state matrix with the displacement shape of each."""
    n = numeric.M.shape[0]
    eigenvalues, vectors = np.linalg.eig(numeric.state_matrices()[0])
    tolerance = 1e-9 * max(np.abs(eigenvalues).max(), 1.0)
    pairs = [(eigenvalues[i], np.conj(eigenvalues[i]), vectors[:n, i]) for i in range(2 * n) if eigenvalues[i].imag > tolerance]
    real = sorted((i for i in range(2 * n) if abs(eigenvalues[i].imag) <= tolerance), key=lambda i: eigenvalues[i].real)
    while len(real) >= 2:
        first = real.pop(0)
        second = max(real, key=lambda i: _likeness(vectors[:n, first], vectors[:n, i]))
        real.remove(second)
        pairs.append((eigenvalues[first], eigenvalues[second], vectors[:n, first]))
    return pairs


def _likeness(left: NDArray[np.complex128], right: NDArray[np.complex128]) -> float:
    norm = np.linalg.norm(left) * np.linalg.norm(right)
    return float(abs(np.vdot(left, right)) / norm) if norm else 0.0


def _match(pairs: list[tuple[complex, complex, NDArray[np.complex128]]], numeric: NumericModel, shapes: Array) -> list[tuple[float, float]]:
    """Give each undamped mode the damped pair of the most similar shape, all at once (assignment problem)."""
    scale = np.sqrt(np.diag(numeric.M))
    radii = [float(np.sqrt(abs(first * second))) for first, second, _ in pairs]
    frequency = np.sqrt(np.maximum(np.einsum("ij,ik,kj->j", shapes, numeric.K, shapes), 0.0))
    cost = np.zeros((shapes.shape[1], len(pairs)))
    for i, shape in enumerate(shapes.T):
        for j, (_, _, vector) in enumerate(pairs):
            detuning = abs(np.log(max(radii[j], 1e-9) / max(frequency[i], 1e-9)))
            cost[i, j] = -_likeness(scale * vector, (scale * shape).astype(complex)) + 0.5 * min(detuning, 2.0)
    chosen = assign(cost)
    result = []
    for j in chosen:
        first, second, _ = pairs[j]
        result.append((radii[j], _ratio(first + second, radii[j])))
    return result


def _ratio(total: complex, radius: float) -> float:
    """Return -(sum of a pair)/(2 radius), zero where it is rounding error."""
    ratio = float(-total.real / (2 * radius)) if radius else 0.0
    return ratio if abs(ratio) > 1e-12 else 0.0


def _names(coordinates: Sequence[Coordinate], shares: list[Array]) -> list[str]:
    """Name modes by their largest energy; where a name would repeat, its second share (or a number) tells them apart."""
    plain = [f"{item.owner} {item.motion}" for item in coordinates]
    names = []
    for share in shares:
        order = np.argsort(share)[::-1]
        name = plain[order[0]]
        if share[order[0]] < _SHARED and len(order) > 1 and share[order[1]] > 0.15:
            name = f"{name} with {plain[order[1]]}"
        names.append(name)
    repeated = {name for name in names if names.count(name) > 1}
    seen: dict[str, int] = {}
    for i, name in enumerate(names):
        if name in repeated:
            seen[name] = seen.get(name, 0) + 1
            names[i] = f"{name} ({seen[name]})"
    return names
