"""Frequencies close enough for the peaks of lightly damped modes, and warnings of modes that hardly any damping holds.

Beside a pole p = -2 pi b + 2 pi i f a response is that of 1/(i w - p): its square falls to a half at f - b and f + b [Hz]. The trapezoidal
rule over f + b sinh(t), evenly spaced in t by d, integrates that square with an error of d^2/6 of the whole.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from vehgen.mechanics import EquationsOfMotion
from vehgen.mechanics.numeric_model import NumericModel
from vehgen.simulate.frequency import MaxwellBranch
from vehgen.simulate.modes import natural_modes

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]
LEAST_DAMPING_RATIO = 1e-6
"""The least damping ratio that is counted on: a mode of 10 Hz takes hours to settle there, and a peak is narrower than files' digits."""
PEAK_STEP = 0.05
"""Lines beside a pole are so far apart, in parts of its half width and, further off, of the distance: RMS is right to 0.02 %."""
RATIO_ROUNDING = 1e-12
"""A damping ratio below it is an eigenvalue's rounding error."""
PEAK_STANDS_OUT, FAR_WIDTHS = 10.0, 300.0
"""A peak counts where an output is so many times louder there than so many half widths away."""
MOST_NAMED = 4
"""So many outputs a warning names."""


def oscillating_poles(numeric: NumericModel, branches: Sequence[MaxwellBranch] = ()) -> Complex:
    """Return the poles of a model and its relaxation laws that oscillate, each once, by ascending frequency `shape (n,)` [1/s]."""
    A = numeric.state_matrices()[0]
    if branches:
        rows, k = np.array([item.row for item in branches]), np.array([item.k for item in branches])
        rates = 1 / np.array([item.time for item in branches])
        n, size = len(numeric.M), len(A)
        A = np.block([[A, np.zeros((size, len(rates)))], [rates[:, None] * rows, np.zeros((len(rates), n)), -np.diag(rates)]])
        pull = np.linalg.solve(numeric.M, rows.T * k)
        A[n:size, size:] = pull
        A[n:size, :n] -= pull @ rows
    found = np.linalg.eigvals(A).astype(np.complex128)
    found = found[found.imag > 0]
    return found[np.argsort(found.imag)]


def with_peaks(frequency: Array, poles: Complex, step: float = PEAK_STEP) -> Array:
    """Return frequencies with lines beside poles, ascending.

    Parameters
    ----------
    frequency
        Ascending [Hz], `shape (n,)`.
    poles
        Those of :func:`oscillating_poles` [1/s].
    step
        As :data:`PEAK_STEP`. Lines beside a pole reach as far as they lie closer together than those of `frequency` do there.
    """
    low, high = frequency[0], frequency[-1]
    parts = [frequency]
    for middle, half in zip(*_peaks(poles), strict=True):
        place = int(np.clip(np.searchsorted(frequency, middle), 1, len(frequency) - 1)) if low < high else 0
        gap = frequency[place] - frequency[place - 1]
        if half * step < gap:
            count = int(np.ceil(np.arccosh(gap / (half * step)) / step))
            near = middle + half * np.sinh(step * (np.arange(-count, count) + 0.5))  # none at the pole, where a response may be infinite
            parts.append(near[(near > low) & (near < high)])
    return np.unique(np.concatenate(parts))


def _peaks(poles: Complex) -> tuple[Array, Array]:
    """Return the frequencies of poles and half the widths of their peaks [Hz], the latter at least those of the least damping."""
    middle = poles.imag / (2 * np.pi)
    return middle, np.maximum(np.abs(poles.real) / (2 * np.pi), LEAST_DAMPING_RATIO * middle)


def undamped_notes(
    model: EquationsOfMotion, values: Mapping[str, float], poles: Complex, frequency: Array, responses: Mapping[str, Complex]
) -> Iterator[str]:
    """Warn of each mode of hardly any damping whose peak stands out in responses by their names, at ascending frequencies [Hz]."""
    ratios = -poles.real / np.abs(poles)
    for pole, ratio, middle, half in zip(poles, ratios, *_peaks(poles), strict=True):
        if ratio >= LEAST_DAMPING_RATIO or not frequency[0] < middle < frequency[-1]:
            continue
        at, *around = (_nearest(frequency, middle + shift * half) for shift in (0.0, -FAR_WIDTHS, FAR_WIDTHS))
        shaken = [name for name, found in responses.items() if abs(found[at]) > PEAK_STANDS_OUT * abs(found[around]).max()]
        if shaken:
            mode = min(natural_modes(model, values), key=lambda mode: abs(mode.pole_hz - abs(pole) / (2 * np.pi)))
            named = ", ".join(shaken[:MOST_NAMED]) + (f" and {len(shaken) - MOST_NAMED} more" if len(shaken) > MOST_NAMED else "")
            shown = ratio if ratio > RATIO_ROUNDING else 0.0
            yield (
                f"{mode.name} at {middle:.4g} Hz has hardly any damping (ratio {shown:.1g}): RMS values and peaks of {named} mean "
                "nothing; give what holds it a damper (`c`)"
            )


def _nearest(frequency: Array, wanted: float) -> int:
    return int(np.abs(frequency - wanted).argmin())
