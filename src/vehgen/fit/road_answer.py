"""How roughness comes into the measured channels: the vehicle's answer to a road that all axles follow one after the other.

    G(f) H(f) R(f) H(f)*,   R_ij = exp(-2 pi i f (t_i - t_j)) exp(-(2 pi f (t_i - t_j) e)^2/2)

is the cross spectral density of the channels on a road of displacement spectrum G = n0^2 v/f^2 (ISO 8608 with w = 2 and Gd(n0) = 1 m^3,
n0 = 0.1 cycles/m, at v [m/s]); axle i meets the road t_i later than the first. A speed that is known within a share e, or strays by it,
leaves unsure when one axle follows the other, and fast motions of both no longer agree.

A record is seen through its window, so that a line holds what lies around it: the density is the mean about the line, weighted by the
window's power. Two channels of one body, which without a window agree as rigidly as it, then agree only as well as H is alike around
the line, and two axles share only the road that both have passed while it was recorded.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property, partial
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from vehgen.fit.reading import Reading
from vehgen.fit.window import taper
from vehgen.road.iso8608 import REFERENCE_CYCLES_PER_M
from vehgen.simulate.frequency import maxwell_branches, transfer_functions

if TYPE_CHECKING:
    from vehgen.fit.adjustments import Adjustment
    from vehgen.fit.trial import Trial

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]
KNOT_WAVENUMBERS = 0.1 * 2.0 ** np.arange(9)
"""Wavenumbers between which the road's level is interpolated [cycles/m]."""
LINES_BESIDE = 8
"""A line holds road from so many lines to each side, through the record's window."""


@dataclass(frozen=True)
class RoadAnswer:
    """The channels' answer to roughness in one trial, at spectral lines.

    `frequency shape (n,)` [Hz]; `wavenumber shape (n,)` [cycles/m]; `gain shape (n, n_channels, n_channels)` with gain gain* = G H R H* as
    the record's window shows it; `dt` the samples' spacing [s]; `forced shape (n, n_channels, n_forces)` likewise for stated errors of
    applied forces, levels apart, and `unstated shape (n, n_channels, n_unstated)` for errors of 1 N of the measured forces that state none.
    """

    frequency: Array
    wavenumber: Array
    gain: Complex
    dt: float
    forced: Complex | None = None
    unstated: Complex | None = None

    @cached_property
    def weights(self) -> Array:
        """:func:`knot_weights` of the lines, which a search of the likeliest noise asks for hundreds of times."""
        return knot_weights(self.wavenumber)


def road_answer(
    trial: Trial, frequency: Array, values: dict[str, float], speed_spread: float = 0.0, *, windowed: bool = True
) -> RoadAnswer:
    """Return the channels' answer to a road of level 1 that all axles follow, at frequencies `shape (n,)` [Hz].

    `speed_spread` is the standard deviation of the run's speed, relative. What is not `windowed` is as an endless record would show it.
    """
    model, speed, dt = trial.simulator.model, trial.scenario.top_speed, trial.recording.dt
    spread = _WindowSpread.of(trial, frequency) if windowed else _WindowSpread(frequency, np.arange(len(frequency)), np.ones(1))
    branches = maxwell_branches(model, values)
    late = trial.scenario.axle_offsets(model.wheel_offsets(values)) / speed
    between = np.abs(late[:, None] - late[None, :])
    agree = np.exp(-((2 * np.pi * speed_spread * spread.frequency[:, None, None] * between) ** 2) / 2)
    delayed = np.exp(-2j * np.pi * spread.frequency[:, None] * late)
    way, pushed = transfer_functions(model.numeric(values), spread.frequency, branches)
    acquired = trial.channel_factors(spread.frequency)[:, :, None]
    size = (REFERENCE_CYCLES_PER_M * np.sqrt(speed) / spread.frequency)[:, None, None]
    way = way[..., : len(late)] * acquired * delayed[:, None] * size
    gain = spread.root(way @ agree @ adjoint(way))
    pushed = (pushed * acquired)[spread.lines]
    errors = np.array([entry.noise or 0.0 for entry in trial.run.file.forces.values()])
    forced = np.asarray(pushed * errors * np.sqrt(2 * dt)) if errors.any() else None
    open_ones = unstated_forces(trial) > 0
    unstated = np.asarray(pushed[..., open_ones] * np.sqrt(2 * dt)) if open_ones.any() else None
    return RoadAnswer(frequency, frequency / speed, np.asarray(gain), dt, forced, unstated)


def as_read(answer: RoadAnswer, reading: Reading | None) -> RoadAnswer:
    """Return what sensors that are not as they should be read of a road's answer; None changes nothing."""
    return answer if reading is None else _each(answer, reading.apply)


def as_adjusted(answer: RoadAnswer, trial: Trial, shared: Sequence[Adjustment], numbers: Array) -> RoadAnswer:
    """Return what sensors read of a road's answer with what is wrong with them in all runs, at its `numbers shape (len(shared),)`."""
    for i, item in enumerate(shared):
        answer = _each(answer, partial(item.read_lines, trial, answer.frequency, numbers[i:]))
    return answer


def _each(answer: RoadAnswer, read: Callable[[Complex], Complex]) -> RoadAnswer:
    """Return an answer of which each part is read so, as lines `shape (n_sources, n, n_channels)`."""
    parts = (answer.gain, answer.forced, answer.unstated)
    gain, forced, unstated = (None if part is None else np.moveaxis(read(np.moveaxis(part, 2, 0)), 0, 2) for part in parts)
    assert gain is not None
    return replace(answer, gain=gain, forced=forced, unstated=unstated)


@dataclass(frozen=True)
class _WindowSpread:
    """How a record's window spreads a density over spectral lines.

    `frequency shape (n_fine,)` [Hz] lie half as far apart as the record's lines and reach beyond them, `lines shape (n,)` are these among
    them, and `weights shape (2 n_beside + 1,)` shares of the densities around a line that it holds.
    """

    frequency: Array
    lines: NDArray[np.intp]
    weights: Array

    @classmethod
    def of(cls, trial: Trial, frequency: Array) -> _WindowSpread:
        """Return it for a trial's lines `shape (n,)` [Hz]."""
        n, dt = len(trial.recording.time), trial.recording.dt
        power = np.abs(np.fft.fft(taper(n, dt, trial.fade_in), 2 * n)) ** 2
        beside = min(2 * LINES_BESIDE, n - 1)
        weights = np.roll(power, beside)[: 2 * beside + 1] / power.sum()
        numbers = np.round(frequency * 2 * n * dt).astype(np.intp)
        fine = np.arange(max(int(numbers[0]) - beside, 1), int(numbers[-1]) + beside + 1)
        return cls(fine / (2 * n * dt), numbers - fine[0], weights)

    def root(self, density: Complex) -> Complex:
        """Return B with B B* the density `shape (n_fine, m, m)` as the lines hold it, `shape (n, m, m)`."""
        held = sum(share * density[self._beside(i)] for i, share in enumerate(self.weights))
        scale = np.sqrt(np.einsum("nii->ni", held).real)
        safe = np.where(scale > 0, scale, 1.0)
        unit = held / (safe[:, :, None] * safe[:, None, :])
        return np.asarray(scale[:, :, None] * np.linalg.cholesky((unit + adjoint(unit)) / 2 + 1e-9 * np.eye(held.shape[1])))

    def _beside(self, number: int) -> NDArray[np.intp]:
        """Return the places of the frequencies that the lines' weights of one number belong to; those beyond are the last."""
        return np.clip(self.lines + number - len(self.weights) // 2, 0, len(self.frequency) - 1)


def unstated_forces(trial: Trial) -> Array:
    """Return the standard deviation of each measured force whose error the run file does not state [N]; 0 of the others."""
    errors = np.array([entry.noise or 0.0 for entry in trial.run.file.forces.values()])
    sizes = np.array([0.0 if item.values is None else np.std(item.values) for item in trial.scenario.forces])
    return np.asarray(sizes * (errors == 0))


def knot_weights(wavenumber: Array) -> Array:
    """Return the weights of ln(levels) at wavenumbers [cycles/m], `shape (n, len(KNOTS))`."""
    hats = np.eye(len(KNOT_WAVENUMBERS))
    return np.column_stack([np.interp(np.log(wavenumber), np.log(KNOT_WAVENUMBERS), hat) for hat in hats])


def adjoint(matrices: Complex) -> Complex:
    """Return the adjoints of matrices `shape (n, m, k)`, `shape (n, k, m)`."""
    return np.asarray(matrices.conj().transpose(0, 2, 1))
