"""The loop over time, the same for all kernels: compiled once for double and once for single precision."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:  # where it is compiled, LOOP_IMPORTS imports it
    from vehgen.codegen.emit_llvm import call_kernel

LOOP_IMPORTS = "from vehgen.codegen.emit_llvm import call_kernel"
LOOP_SIGNATURE = (
    "void(i8, {f}[::1], i8, {f}, {f}[:, ::1], {f}[:, ::1], {f}[:, ::1], i8, {f}[:, :, ::1], {f}[:, :, ::1], {f}[:, :, ::1],"
    " i8[:, :, ::1], i8, i8, {f}[:, :, ::1], {f}[::1])"
)
SHARED_SIGNATURE = "void({f}[:, :, ::1], i8, i8, i8, i8, {f}[:, ::1], i8)"


def read_shared(array: NDArray[Any], first: int, last: int, pattern: int, every: int, rows: NDArray[Any], place: int) -> None:
    """Write what all lanes read of an array's columns, at every so manieth step, to the columns of `rows` from `place` on."""
    last_step, half, width = array.shape[1] - 1, array.dtype.type(0.5), array.shape[2]
    if pattern > 0 and every == 1 and last - first == width and rows.shape[1] == width:  # all of them: as one long array, which is quicker
        values, found = array[0].reshape(-1), rows.reshape(-1)
        begin = values.size - width
        for i in range(width):
            found[begin + i] = values[begin + i]
        now, after, target = values[:begin], values[width:], found[:begin]
        for i in range(begin):
            target[i] = half * (now[i] + after[i])
        if pattern == 2:
            later, target = values[2 * width :], found[width:]
            for i in range(later.size):
                target[i] = half * (now[i] + later[i]) + after[i]
            for i in range(width if last_step > 0 else 0):
                found[begin + i] = half * (values[begin - width + i] + values[begin + i]) + values[begin + i]
        return
    for i in range(first, last):
        at = place + i - first
        if pattern == 0:
            for row in range(rows.shape[0]):
                rows[row, at] = array[0, row * every, i]
        elif pattern == 1:
            for row in range(rows.shape[0]):
                n = row * every
                rows[row, at] = half * (array[0, n, i] + array[0, min(n + 1, last_step), i])
        else:
            rows[0, at] = half * (array[0, 0, i] + array[0, min(1, last_step), i])
            for n in range(1, last_step):
                rows[n, at] = half * (array[0, n - 1, i] + array[0, n + 1, i]) + array[0, n, i]
            if last_step > 0:
                rows[last_step, at] = half * (array[0, last_step - 1, i] + array[0, last_step, i]) + array[0, last_step, i]


def advance_block(
    kernel: Any,
    work: NDArray[Any],
    lanes: int,
    dt: float,
    beginnings: NDArray[Any],
    steps: NDArray[Any],
    samples: NDArray[Any],
    shares: int,
    inputs: NDArray[Any],
    rates: NDArray[Any],
    forces: NDArray[Any],
    reads: NDArray[np.int64],
    keep: int,
    ends: int,
    responses: NDArray[Any],
    residuals: NDArray[Any],
) -> None:
    """Advance the individuals of a block over all steps, so many lanes after the other, all driven by one set of inputs or each by its own.

    Parameters
    ----------
    kernel, work, lanes, dt
        The kernel's function, its work array of so many lanes, and the step [s].
    beginnings
        What stands in each individual's lane at first: parameters, space for constants, and states; channels follow there.
    steps, samples, shares
        Where all lanes share their drives (1): rows of them, one a step and one a kept sample, see :func:`read_shared`. Else (0) space for
        rows of drives times lanes, which are read as the loop comes to them: some samples, and as many steps as lie between them.
    inputs, rates, forces
        `shape (sets, steps + 1, width)`; individuals beyond the last set take that one. Read where lanes do not share.
    reads
        `shape (3, 3, 4)`, see :class:`vehgen.codegen.drive_reads.DriveReads`.
    keep
        Steps from kept sample to kept sample.
    ends
        Whether a step ends in the state of its sample (1), else it begins there (0).
    responses, residuals
        `shape (n_individuals, n_samples, n_channels)` and `(n_individuals,)`: the channels and each last state, which are written.
    """
    n_steps, half, kept = inputs.shape[1] - 1, work.dtype.type(0.5), beginnings.shape[1] * lanes
    for lane in range(0, responses.shape[0], lanes):
        active = min(lanes, responses.shape[0] - lane)
        for j in range(lanes):
            own = min(lane + j, responses.shape[0] - 1)
            for i in range(beginnings.shape[1]):
                work[i * lanes + j] = beginnings[own, i]
        call_kernel(kernel, 0, work, active, dt, steps, 0, 0, samples, 0)
        for start in range(0, responses.shape[1], samples.shape[0]):
            stop = min(start + samples.shape[0], responses.shape[1])
            begin = max((start - 1) * keep + 1 if ends else start * keep, 0)
            for group in range(3 * (1 - shares)):
                rows, first, every, count = steps, begin, 1, min((stop - 1 + (1 - ends)) * keep + ends, n_steps + ends) - begin
                if group > 0:
                    rows, first, every, count = samples, max(start * keep, 0), max(keep, 1), stop - start
                for a in range(3):
                    array = inputs if a == 0 else rates if a == 1 else forces
                    left, right, place, pattern = reads[group, a]
                    place = (place - left - reads[min(group, 1), 0, 2]) * lanes
                    last_set = array.shape[0] - 1
                    for row in range(count):
                        n = first + row * every
                        before, after = max(n - 1, 0), min(n + 1, n_steps)
                        for i in range(left, right):
                            for j in range(active):
                                own = min(lane + j, last_set)
                                value = array[own, n, i]
                                if pattern == 1 or (pattern == 2 and n == 0):
                                    value = half * (value + array[own, after, i])
                                elif pattern == 2:
                                    value += half * (array[own, before, i] + array[own, after, i])
                                rows[row, place + i * lanes + j] = value
            for sample in range(start, stop):
                first = max((sample - 1) * keep + 1, 0) if ends else sample * keep
                last = sample * keep + 1 if ends else min((sample + 1) * keep, n_steps)
                call_kernel(kernel, 1, work, active, dt, steps, first - begin, last - first, samples, sample - start)
                for channel in range(responses.shape[2]):
                    for j in range(active):
                        responses[lane + j, sample, channel] = work[kept + channel * lanes + j]
        for j in range(active):
            residuals[lane + j] = work[kept - lanes + j]
