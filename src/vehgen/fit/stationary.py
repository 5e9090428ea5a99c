"""Noise as no window shows it: drawn at random, and what recordings in it truly tell.

A fit weighs the lines of a windowed record as if they were independent. They are not: much of a line is road from beside it, which an
axle passes before the record begins or after it ends. In derivatives from the middle of a record, as those of a hump, that cancels
from line to line. With H = J'J of the fit, its priors included, and B the covariance of its score on stationary noise
of density S(f),

    B_ab = 4 int Re(G_a* S G_b) df,

G_a the spectrum of what the score multiplies a recording with, the covariance of the unknowns is H^-1 B H^-1 and their information H B^-1 H
(V. P. Godambe, Ann. Math. Stat. 31 (1960) 1208-1211, doi:10.1214/aoms/1177705693). Priors add 1 to B, too.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from vehgen.fit.least_squares import LeastSquaresFit
from vehgen.fit.linearisation import linearise
from vehgen.fit.misfit import Misfit
from vehgen.fit.road_answer import LINES_BESIDE, RoadAnswer
from vehgen.fit.window import pulled_back

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]
SMALLEST_SHARE = 1e-12
"""What is told by a smaller share of what is told most counts as nothing."""


def draw(misfit: Misfit, x: Array, random: np.random.Generator) -> list[Array]:
    """Return measurements as they might have come out at unknowns x: the response plus noise, one array a trial (for a bootstrap)."""
    found = []
    for number, (trial, simulated) in enumerate(zip(misfit.problem.trials, misfit.simulate(x), strict=True)):
        n = len(simulated)
        lines, answer = _unwindowed(misfit, number, x, 0)
        found.append(simulated + misfit.noises[trial.name].draw(answer, 2 * n, lines, random)[:n])
    return found


def recorded_information(fit: LeastSquaresFit) -> Array:
    """Return the information of the recordings and of the errors' priors about all unknowns of a fit, `shape (n_unknowns, n_unknowns)`."""
    misfit, linearised = fit.misfit, linearise(fit.misfit, fit.x)
    priors = np.arange(misfit.n_unknowns) >= misfit.n_unknowns - misfit.n_errors
    own, scattered = linearised.information(), np.diag(priors.astype(np.float64))
    for number, (columns, block) in enumerate(zip(linearised.columns, linearised.blocks, strict=True)):
        scattered[np.ix_(columns, columns)] += score_covariance(misfit, fit.x, number, block)
    size = 1 / np.sqrt(np.maximum(np.diagonal(scattered), 1e-300))
    inverse = np.linalg.pinv(size[:, None] * scattered * size, SMALLEST_SHARE, hermitian=True)
    return np.asarray(own @ (size[:, None] * inverse * size) @ own)


def score_covariance(misfit: Misfit, x: Array, number: int, slopes: Complex) -> Array:
    """Return the covariance of trial `number`'s part of the score, `shape (n, n)`, at unknowns x.

    `slopes shape (n, n_lines, n_channels)` are the derivatives of its whitened lines.
    """
    trial = misfit.problem.trials[number]
    n_samples, dt = trial.recording.values.shape[0], trial.recording.dt
    numbers, n_channels = _numbers(misfit, number), slopes.shape[2]
    one_each = np.zeros((n_channels, len(numbers), n_channels), dtype=np.complex128)
    one_each[:] = np.eye(n_channels)[:, None, :]
    back = misfit.whiten(number, one_each).conj().transpose(1, 2, 0)
    pulled = (slopes.swapaxes(0, 1) @ back).swapaxes(0, 1)
    lines, answer = _unwindowed(misfit, number, x, LINES_BESIDE)
    spectra = [np.fft.rfft(pulled_back(item, n_samples, dt, numbers, trial.window), 2 * n_samples, axis=0)[lines] for item in pulled]
    scores = np.stack(spectra, axis=1)
    felt = scores @ misfit.noises[trial.name].density(answer).swapaxes(1, 2)
    both = np.tensordot(scores.conj(), felt, axes=((0, 2), (0, 2)))
    return np.asarray(4 / (2 * n_samples * dt) * both.real)


def _unwindowed(misfit: Misfit, number: int, x: Array, beside: int) -> tuple[NDArray[np.intp], RoadAnswer]:
    """Return the lines of a record twice as long in trial `number`'s band and so many of its own to each side, and the road there."""
    trial = misfit.problem.trials[number]
    n, numbers = trial.recording.values.shape[0], _numbers(misfit, number)
    lines = np.arange(max(2 * (int(numbers[0]) - beside), 1), min(2 * (int(numbers[-1]) + beside), n) + 1)
    reference = misfit.problem.best_values(misfit.problem.space.values(misfit.split(x)[0]))
    return lines, misfit.answer(number, lines / (2 * n * trial.recording.dt), reference, x, windowed=False)


def _numbers(misfit: Misfit, number: int) -> NDArray[np.intp]:
    """Return which lines of trial `number`'s spectrum are compared."""
    recording = misfit.problem.trials[number].recording
    return np.round(misfit.frequency(number) * len(recording.time) * recording.dt).astype(np.intp)
