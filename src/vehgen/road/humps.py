"""Humps: shapes with a start, a length and a height along the road."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache, partial

import numpy as np
from numpy.typing import NDArray

from vehgen.errors import InputError, did_you_mean, shown

Array = NDArray[np.float64]
Shape = Callable[[Array], Array]
_PER_LOBE = 1000
"""Spacing of the frequencies at which a hump's spectrum is looked at: so many to one cycle over its length."""
_LOBES = 500
"""So many cycles over a hump's length are looked at: beyond, its nulls lie closer than any mode is wide."""

_ROUNDED_BY_M = 0.008
"""Standard deviation of the Gaussian mean that rounds edges [m]; shares of it stand for narrower and wider ones."""
_ROUNDED_REACH_M = 0.032
_ROUNDED_STEP_M = 1e-3


@dataclass(frozen=True)
class Hump:
    """A hump from `at` to `at + length` [m]; `shape` gives its height [m] at s in [0, length] from its start."""

    at: float
    length: float
    shape: Shape

    @property
    def end(self) -> float:
        """Where it ends along the road [m]."""
        return self.at + self.length

    def height(self, s: Array) -> Array:
        """Return the height at positions s along the road [m]; zero outside the hump."""
        local = (np.asarray(s, dtype=np.float64) - self.at).ravel()
        inside = np.flatnonzero((local > 0) & (local < self.length))
        heights = np.zeros(len(local))
        heights[inside] = self.shape(local[inside])
        return heights.reshape(np.shape(s))

    @classmethod
    def from_shape(cls, name: str, at: float, length: float, height: float, **extra: float) -> Hump:
        """Make a half_sine, versine, trapezoid (`ramp` share of the length) or rectangle (`radius` of its edges).

        Raises
        ------
        InputError
            For an unknown shape, or dimensions that do not fit it.
        """
        makers: dict[str, Callable[..., Shape]] = {
            "half_sine": half_sine,
            "versine": versine,
            "trapezoid": trapezoid,
            "rectangle": rectangle,
        }
        if name not in makers:
            raise InputError(f"unknown hump shape {shown(name)}; {did_you_mean(name, makers)}")
        if not (length > 0 and np.isfinite([at, length, height]).all()):
            raise InputError(f"a hump needs a positive length and finite numbers, found length {length} m, height {height} m, at {at} m")
        return cls(at, length, makers[name](length, height, **extra))

    @classmethod
    def from_points(cls, at: float, distance: Array, height: Array) -> Hump:
        """Make a hump from points `distance`, `height` [m] `shape (n,)`, linear between them."""
        distance, height = np.asarray(distance, dtype=np.float64), np.asarray(height, dtype=np.float64)
        if len(distance) < 2 or (np.diff(distance) <= 0).any():
            raise InputError("a hump of points needs at least two, with ascending distances")
        start = distance - distance[0]
        return cls(at, float(start[-1]), partial(_points, distance=start, height=height))

    def deformed(self, length: float = 1.0, form: float = 1.0, skew: float = 0.0, rounding: float = 0.0) -> Hump:
        """Return the hump as it may really be, starting where it starts.

        Parameters
        ----------
        length
            Its length over that of the drawing.
        form
            Exponent of its height over its highest: below 1 it is fuller, above 1 more pointed (a half sine of form 2 is a versine).
        skew
            By which share its far end is higher and its near end lower than drawn: a hump that lies tilted.
        rounding
            By how much its edges are worn, or bridged by the tyre: the mean square of the distances over which its height is averaged
            [m^2]; below 0 they are sharper than drawn.
        """
        shape = partial(_deformed, shape=self.shape, whole=self.length, change=(length, form, skew))
        if rounding == 0.0:
            return Hump(self.at, length * self.length, shape)
        distance = np.arange(-_ROUNDED_REACH_M, length * self.length + _ROUNDED_REACH_M + _ROUNDED_STEP_M, _ROUNDED_STEP_M)
        heights = np.zeros_like(distance)
        inside = (distance > 0) & (distance < length * self.length)
        heights[inside] = shape(distance[inside])
        mean = np.convolve(heights, _rounding_weights(), mode="same")
        return Hump.from_points(self.at + distance[0], distance, heights + rounding / _ROUNDED_BY_M**2 * (mean - heights))

    def spectral_nulls(self, speed: float, f_max: float) -> Array:
        """Return the frequencies up to `f_max` [Hz] at which the hump, crossed at `speed` [m/s], excites nothing.

        They are the minima of its Fourier transform that fall below a thousandth of their surroundings.
        """
        s = np.linspace(0.0, self.length, 4001)
        profile = self.shape(s)
        step = 1 / _PER_LOBE * speed / self.length
        frequency = np.arange(step, min(f_max, _LOBES * speed / self.length) + 5 * step, step)
        magnitude = np.abs(_transform(profile, len(frequency)))
        scale = np.maximum.accumulate(magnitude[::-1])[::-1]
        middle = magnitude[1:-1]
        low = (middle <= magnitude[:-2]) & (middle < magnitude[2:]) & (middle < 5e-3 * np.maximum(scale[1:-1], 1e-3 * magnitude.max()))
        found = frequency[1:-1][low]
        return np.asarray(found[found <= f_max])


def _transform(profile: Array, count: int) -> NDArray[np.complex128]:
    """Return the Fourier transform of `profile shape (n,)` over its length at k/_PER_LOBE cycles a length, k = 1..count.

    By Bluestein's chirp transform: k j = (k^2 + j^2 - (k - j)^2)/2 turns the sum over j into a convolution
    (L. I. Bluestein, IEEE Trans. Audio Electroacoust. 18 (1970) 451-455), count log(count) instead of count n.
    """
    n = len(profile)
    period = _PER_LOBE * (n - 1)
    index = np.arange(max(n, count + 1), dtype=np.int64)
    chirp = np.exp(-1j * np.pi * (index**2 % (2 * period)) / period)
    weights = np.ones(n)
    weights[[0, -1]] = 0.5
    size = 1 << int(n + count).bit_length()
    answer = np.zeros(size, dtype=np.complex128)
    answer[: count + 1] = chirp[: count + 1].conj()
    answer[size - n + 1 :] = chirp[1:n].conj()[::-1]
    found = np.fft.ifft(np.fft.fft(weights * profile * chirp[:n], size) * np.fft.fft(answer))
    return np.asarray(found[1 : count + 1] * chirp[1 : count + 1] / (n - 1))


def half_sine(length: float, height: float) -> Shape:
    """Return height*sin(pi s/length)."""
    return partial(_half_sine, length=length, height=height)


def versine(length: float, height: float) -> Shape:
    """Return height*(1 - cos(2 pi s/length))/2."""
    return partial(_versine, length=length, height=height)


def trapezoid(length: float, height: float, ramp: float = 0.25) -> Shape:
    """Return linear ramps over the share `ramp` of the length at both ends, and a flat top."""
    if not 0 < ramp <= 0.5:
        raise InputError(f"the ramp of a trapezoid is a share of its length in (0, 0.5], found {ramp}")
    return partial(_trapezoid, length=length, height=height, ramp=ramp)


def rectangle(length: float, height: float, radius: float) -> Shape:
    """Return a rectangle whose edges rise by two circular arcs of `radius`, foot and shoulder, that meet half-way up.

    An arc that turns by the angle a covers radius*sin(a) along the road and radius*(1 - cos(a)) upwards; half of the height fixes a.
    Edges of 2*radius or higher would need a vertical wall between the arcs and are refused.
    """
    rise = abs(height)
    if not radius > 0 or rise > 2 * radius:
        raise InputError(f"the edges of a rectangle of height {height} m need a radius of at least {rise / 2} m, found {radius} m")
    run = np.sqrt(radius**2 - (radius - rise / 2) ** 2)
    if 4 * run > length:
        raise InputError(f"the rounded edges take {4 * run:.3f} m of a hump of {length} m; make it longer or the radius smaller")

    return partial(_rectangle, length=length, height=height, radius=radius, run=float(run))


def _deformed(s: Array, shape: Shape, whole: float, change: tuple[float, float, float]) -> Array:
    length, form, skew = change
    share = s / (whole * length)
    heights = shape(whole * share)
    highest = 0.0 if form == 1.0 else _highest(shape, whole)
    if highest > 0:
        heights = np.copysign(highest * (np.abs(heights) / highest) ** form, heights)
    return np.asarray(heights * (1 + skew * (2 * share - 1)))


@lru_cache(maxsize=1)
def _rounding_weights() -> Array:
    """Return the weights of a Gaussian mean about the middle one."""
    reach = round(_ROUNDED_REACH_M / _ROUNDED_STEP_M)
    weights = np.exp(-0.5 * (np.arange(-reach, reach + 1) * _ROUNDED_STEP_M / _ROUNDED_BY_M) ** 2)
    return np.asarray(weights / weights.sum())


@lru_cache(maxsize=64)
def _highest(shape: Shape, whole: float) -> float:
    """Return the largest height of a hump's shape, or depth."""
    return float(np.abs(shape(np.linspace(0.0, whole, 201))).max())


def _points(s: Array, distance: Array, height: Array) -> Array:
    return np.asarray(np.interp(s, distance, height), dtype=np.float64)


def _half_sine(s: Array, length: float, height: float) -> Array:
    return np.asarray(height * np.sin(np.pi * s / length))


def _versine(s: Array, length: float, height: float) -> Array:
    return np.asarray(0.5 * height * (1.0 - np.cos(2.0 * np.pi * s / length)))


def _trapezoid(s: Array, length: float, height: float, ramp: float) -> Array:
    return np.asarray(height * np.clip(np.minimum(s, length - s) / (ramp * length), 0.0, 1.0))


def _rectangle(s: Array, length: float, height: float, radius: float, run: float) -> Array:
    edge = np.minimum(np.minimum(s, length - s), 2 * run)
    foot = radius - np.sqrt(np.maximum(radius**2 - np.minimum(edge, run) ** 2, 0.0))
    shoulder = abs(height) - (radius - np.sqrt(np.maximum(radius**2 - np.minimum(2 * run - edge, run) ** 2, 0.0)))
    return np.asarray(np.copysign(1.0, height) * np.where(edge < run, foot, shoulder))
