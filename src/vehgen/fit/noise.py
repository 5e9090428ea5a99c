"""What the measured channels hold besides the vehicle's answer to the known road: sensor noise, and the roughness under the hump.

    S(f) = L(f/v) G(f) H(f) R(f) H(f)* + diag(2 dt sigma^2)

is the one-sided cross spectral density of the channels: noise of standard deviation sigma in each, white or with a density that falls as
(f/COLOUR_AT)^-slope (phones' noise is a little red), and the answer to a road of displacement spectrum L G(f), as a record shows it
(:mod:`vehgen.fit.road_answer`). L is Gd(n0) [m^3] where the road keeps to ISO 8608's w = 2; real roads do not, so L may vary with
wavenumber, straight lines between KNOTS on log-log paper. The road's part is what a white-noise model misses: it is coloured, common to
all channels, and stronger than a phone's own noise even on a very good road. White errors of applied forces, where a run file states
them, come to the channels in the same way: H_F(f) diag(2 dt sigma_F^2) H_F(f)* is added.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import scipy
from numpy.typing import NDArray

from vehgen.fit.parallel import one_blas_thread
from vehgen.fit.road_answer import KNOT_WAVENUMBERS, RoadAnswer, adjoint, knot_weights
from vehgen.fit.whittle import loss_and_slopes

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]
SMALLEST_LEVEL, LARGEST_LEVEL = 1e-10, 1e-2
"""A road smoother than this Gd(n0) [m^3] counts as even (class A begins at 16e-6); none is rougher."""
ROUGHEST_LEVEL = 3.0
"""Change of ln(level) from one knot to the next that counts as one standard deviation."""
ROUGHEST_RUN = 1.0
"""Difference of ln(level) between one trial's road and all of them that counts as one standard deviation ..."""
MOST_RUN_SIGMAS = 3.0
"""... of which it may be so many."""
EVEN = np.full(len(KNOT_WAVENUMBERS), SMALLEST_LEVEL)
"""Levels of an even road."""
LOUDER_HZ = (0.0, 3.0, 8.0, 15.0, 25.0)
"""Where the bands begin in which noise may be louder than sensors and a linear vehicle make it [Hz]."""
COLOUR_AT = 44.0
"""Frequency at which coloured noise has the density of white noise of its sigma [Hz]: the top of the band, where it is measured."""


@dataclass(frozen=True)
class DrawnRoughness:
    """What roughness makes of the channels, from drawn roads: a density `shape (n, n_channels, n_channels)` at frequencies `(n,)` [Hz].

    `shift shape (n_samples, n_channels)` is by how much the mean of what sensors read differs from what they read where only humps are:
    friction that roughness shakes loose holds a hump's motion less.
    """

    frequency: Array
    density: Complex
    shift: Array

    def at(self, frequency: Array) -> Complex:
        """Return the density at other frequencies [Hz], that of the nearest one it knows."""
        middle = (self.frequency[1:] + self.frequency[:-1]) / 2
        return np.asarray(self.density[np.searchsorted(middle, frequency)])


@dataclass(frozen=True)
class Noise:
    """Roughness `levels shape (len(KNOTS),)` [m^3] of the road beneath, and noise `sigma shape (n_channels,)` [channels' units].

    The noise's density falls as f^-slope; 0 is white. `louder shape (len(LOUDER_HZ), n_channels)` are factors of each
    channel's density from these frequencies on, by what no other channel shares: laws make harmonics where H has none.
    `drawn` stands in for L G H R H*, and for `louder`, where H does not say what roughness makes of a vehicle with laws. `acting
    shape (n_unstated,)` are the unstated errors of measured forces, white [N]; None without.
    """

    levels: Array
    sigma: Array
    slope: float = 0.0
    louder: Array | None = None
    drawn: DrawnRoughness | None = None
    acting: Array | None = None

    def unshifted(self, values: Array) -> Array:
        """Return a recording less what roughness shifts of it, `shape (n_samples, n_channels)`; one of another length as it is."""
        if self.drawn is None or self.drawn.shift.shape != values.shape:
            return values
        return np.asarray(values - self.drawn.shift)

    def level(self, wavenumber: Array) -> Array:
        """Return L at wavenumbers [cycles/m]."""
        return np.asarray(np.exp(knot_weights(wavenumber) @ np.log(self.levels)))

    def rougher(self, factor: float) -> Noise:
        """Return the noise of a road so many times as rough (as a level)."""
        levels = np.clip(self.levels * factor, SMALLEST_LEVEL, LARGEST_LEVEL)
        drawn = None if self.drawn is None else replace(self.drawn, density=factor * self.drawn.density)
        return replace(self, levels=levels, drawn=drawn)

    def density(self, answer: RoadAnswer) -> Complex:
        """Return S(f), `shape (n, n_channels, n_channels)`."""
        scale, shared = self._shared(answer)
        return np.asarray(scale[:, :, None] * shared * scale[:, None, :])

    def whitener(self, answer: RoadAnswer) -> Complex:
        """Return W(f) with W S W* = 1, `shape (n, n_channels, n_channels)`."""
        scale, shared = self._shared(answer)
        return np.asarray(np.linalg.inv(np.linalg.cholesky(shared)) / scale[:, None, :], dtype=np.complex128)

    def _shared(self, answer: RoadAnswer) -> tuple[Array, Complex]:
        """Return d `shape (n, n_channels)` and T with S = diag(d) T diag(d), which is well conditioned however small sigma is."""
        if self.drawn is None:
            scale, b = self._scaled(answer)
            return scale, np.asarray(np.eye(len(self.sigma)) + b @ adjoint(b))
        scale = self._scale(answer)
        drawn = self.drawn.at(answer.frequency)
        for part in self._forced(answer):
            drawn = drawn + part @ adjoint(part)
        return scale, np.asarray(np.eye(len(self.sigma)) + drawn / scale[:, :, None] / scale[:, None, :])

    def loss(self, lines: Complex, answer: RoadAnswer) -> float:
        """Return -2 ln of Whittle's likelihood of lines `shape (n, n_channels)`, less a constant: the sum of 2 (ln det S + R* S^-1 R)."""
        if self.drawn is None:
            return self.loss_and_slopes(lines, answer)[0]
        density = self.density(answer)
        weighted = np.linalg.solve(density, lines[:, :, None])[:, :, 0]
        return float(2 * (np.linalg.slogdet(density)[1].sum() + (lines.conj() * weighted).real.sum()))

    def loss_and_slopes(self, lines: Complex, answer: RoadAnswer) -> tuple[float, Array, Array]:
        """Return :meth:`loss` with its derivatives by ln(levels) `shape (len(KNOTS),)` and by ln(sigma) `shape (n_channels,)`.

        Of noise that is neither louder nor drawn: the derivatives know nothing of that.
        """
        level = np.exp(answer.weights @ np.log(self.levels))
        forced = np.concatenate([answer.gain[..., :0], *self._forced(answer)], axis=2)
        loss, by_level, by_sigma = loss_and_slopes(lines, self._scale(answer), level, answer.gain, forced)
        return loss, answer.weights.T @ by_level, by_sigma

    def _scaled(self, answer: RoadAnswer) -> tuple[Array, Complex]:
        """Return d `shape (n, n_channels)` and b with S = diag(d) (1 + b b*) diag(d), which is well conditioned however small sigma is."""
        scale = self._scale(answer)
        return scale, self._part(answer) / scale[:, :, None]

    def _scale(self, answer: RoadAnswer) -> Array:
        """Return the root of the density of each channel's own, `shape (n, n_channels)`: the sensors', and what makes it louder."""
        colour = (np.maximum(answer.frequency, 1e-3) / COLOUR_AT) ** (-self.slope / 2)
        own = np.sqrt(2 * answer.dt) * colour[:, None] * self.sigma
        if self.louder is None:
            return np.asarray(own)
        more = self.louder[np.searchsorted(LOUDER_HZ, answer.frequency, side="right") - 1] - 1
        return np.asarray(np.sqrt(own**2 + more * (own**2 + (np.abs(self._part(answer)) ** 2).sum(axis=2))))

    def _part(self, answer: RoadAnswer) -> Complex:
        """Return P with S = P P* + the sensors' own density, `shape (n, n_channels, n_axles + n_forces)`."""
        level = np.exp(answer.weights @ np.log(self.levels))
        road = np.sqrt(level)[:, None, None] * answer.gain
        return np.concatenate([road, *self._forced(answer)], axis=2)

    def _forced(self, answer: RoadAnswer) -> list[Complex]:
        stated = [] if answer.forced is None else [answer.forced]
        return stated if self.acting is None or answer.unstated is None else [*stated, self.acting * answer.unstated]

    def draw(self, answer: RoadAnswer, n_samples: int, lines: NDArray[np.intp], random: np.random.Generator) -> Array:
        """Return noise within the band of `lines` (numbers of the FFT's lines) as time histories `shape (n_samples, n_channels)`."""
        scale, shared = self._shared(answer)
        shape = (len(lines), len(self.sigma), 1)
        unit = (random.standard_normal(shape) + 1j * random.standard_normal(shape)) / np.sqrt(2)
        spectrum = np.zeros((n_samples // 2 + 1, len(self.sigma)), dtype=np.complex128)
        spectrum[lines] = scale * (np.linalg.cholesky(shared) @ unit)[:, :, 0] * np.sqrt(n_samples / (2 * answer.dt))
        return np.asarray(np.fft.irfft(spectrum, n_samples, axis=0))


def estimate_noise(residuals: Sequence[tuple[Complex, RoadAnswer]], start: Noise, *, same_road: bool = False) -> tuple[Noise, ...]:
    """Return the most likely noise of trials with the same channels, from residuals, lines `shape (n, n_channels)`: a noise a trial.

    Sensors are as loud in all trials. Roads are of one kind, but not equally rough: a vehicle never takes the same track twice, and the
    roughness beneath one pass differs from the next by a factor of its own. A road that reaches no channel, as of a rig, is even.

    Parameters
    ----------
    residuals
        Lines and the road's way into them, trial by trial.
    start
        Where to begin.
    same_road
        All roads are equally rough.
    """
    power = np.mean([np.mean(np.abs(lines) ** 2, axis=0) / (2 * answer.dt) for lines, answer in residuals], axis=0)
    floor = 1e-4 * np.sqrt(power)
    knots, count = len(KNOT_WAVENUMBERS), len(residuals)
    spread = 0 if same_road or count == 1 else count

    def read(x: Array) -> tuple[Noise, ...]:
        sigma, factors = np.exp(x[knots + spread :]), np.exp(x[knots : knots + spread] if spread else np.zeros(count))
        return tuple(Noise(np.exp(x[:knots]) * factor, sigma, start.slope) for factor in factors)

    def loss(x: Array) -> tuple[float, Array]:
        bends, factors = np.diff(x[:knots]), x[knots : knots + spread]
        slopes = np.zeros_like(x)
        # holds levels that no line tells to their neighbours, and the trials' to one another
        total = float((bends**2).sum() / ROUGHEST_LEVEL**2 + (factors**2).sum() / ROUGHEST_RUN**2)
        slopes[:knots] = 2 / ROUGHEST_LEVEL**2 * (np.append(0.0, bends) - np.append(bends, 0.0))
        slopes[knots : knots + spread] = 2 / ROUGHEST_RUN**2 * factors
        for i, (noise, (lines, answer)) in enumerate(zip(read(x), residuals, strict=True)):
            own, by_level, by_sigma = noise.loss_and_slopes(lines, answer)
            total += own
            slopes[:knots] += by_level
            slopes[knots + spread :] += by_sigma
            if spread:
                slopes[knots + i] += by_level.sum()
        return total, slopes

    share = np.mean([np.mean(np.abs(lines) ** 2 / (np.abs(answer.gain) ** 2).sum(axis=2).clip(1e-300)) for lines, answer in residuals])
    mostly_road = Noise(np.full(knots, share), 0.1 * np.sqrt(power), start.slope)
    bounds = [(np.log(SMALLEST_LEVEL), np.log(LARGEST_LEVEL))] * knots
    bounds += [(-MOST_RUN_SIGMAS * ROUGHEST_RUN, MOST_RUN_SIGMAS * ROUGHEST_RUN)] * spread + [
        (np.log(low), np.log(low) + 12.0) for low in floor
    ]
    found = []
    with one_blas_thread():  # a dozen unknowns: more threads only wait for one another
        for first in (start, mostly_road):
            levels, sigma = np.clip(first.levels, SMALLEST_LEVEL, LARGEST_LEVEL), np.maximum(first.sigma, floor)
            begun = np.concatenate([np.log(levels), np.zeros(spread), np.log(sigma)])
            found.append(scipy.optimize.minimize(loss, begun, jac=True, method="L-BFGS-B", bounds=bounds))
    noises = read(min(found, key=lambda item: float(item.fun)).x)
    is_reached = any(np.any(answer.gain) for _, answer in residuals)
    return noises if is_reached else tuple(replace(noise, levels=EVEN) for noise in noises)
