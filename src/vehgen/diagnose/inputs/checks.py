"""What recordings show by themselves: clipped and stuck channels, and runs too much alike to tell effects apart.

A clipped sensor leaves a gap that some effect of the library closes in part: the diagnosis would name it with confidence.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from vehgen.diagnose.inputs.fault import MeasurementFault
from vehgen.fit.trial import Trial
from vehgen.measure.quality import find_clipping, has_cut

Array = NDArray[np.float64]
CLIPPED_PILE_UP = 4
"""So many times as many samples at an extreme as at the next value, two of them in a row, count as clipping: recordings come filtered and
resampled here, and a clipped one that a file of other origin holds may keep few samples in a row. It must have cut something off."""
STUCK = 0.3
"""A channel that does not change for this long [s] while the others move is stuck."""
MOVING_SHARE = 0.5
"""The others move where their RMS is at least this share of that of their whole run."""
COARSE_RESOLUTION = 0.1
"""A channel whose smallest change is more than this share of its RMS is too coarse to be called stuck."""
AT_REST_ZERO = ("acceleration", "pitch_rate", "pitch_acceleration")
"""Quantities whose mean over a run is next to nothing."""
MOSTLY_DRIFT = 1.0
"""RMS of mean and trend over that of the rest from which a channel is mostly drift."""
ALIKE_SHARE = 0.1
"""Amplitudes and speeds within this share of one another are one."""


def check_inputs(trials: Sequence[Trial]) -> tuple[MeasurementFault, ...]:
    """Return the channels that are clipped, stuck, or mostly offset and drift."""
    return tuple(item for trial in trials for item in (*_clipped(trial), *_stuck(trial), *_drifting(trial)))


def _clipped(trial: Trial) -> Iterator[MeasurementFault]:
    for name, values in zip(trial.channels, trial.recording.values.T, strict=True):
        found = [item for item in find_clipping(values, 2, min_pile_up=CLIPPED_PILE_UP) if has_cut(values, item)]
        if found:
            levels, count = [f"{item.level:.4g}" for item in found], sum(item.n_samples for item in found)
            yield MeasurementFault(
                "clipped",
                (trial.name,),
                (name,),
                f"{trial.name}: {name} is clipped at {' and '.join(levels)} in {count} samples ({100 * count / len(values):.2g} %)",
                "record again with a sensor of larger range, at a lower speed or over a lower hump, or leave this run out",
            )


def _stuck(trial: Trial) -> Iterator[MeasurementFault]:
    values, dt = trial.recording.values, trial.recording.dt
    rms = np.maximum(np.sqrt(np.mean(values**2, axis=0)), 1e-300)
    power = (values / rms) ** 2
    for column, name in enumerate(trial.channels):
        jumps = np.abs(np.diff(values[:, column]))
        if jumps[jumps > 0].min(initial=np.inf) > COARSE_RESOLUTION * rms[column]:
            continue
        others = np.delete(power, column, axis=1)
        changes = np.flatnonzero(jumps) + 1
        edges = np.concatenate([[0], changes, [len(values)]])
        for first, last in pairwise(edges.tolist()):
            if (last - first) * dt < STUCK or not others.shape[1] or others[first:last].mean() < MOVING_SHARE**2:
                continue
            level, share = values[first, column], 100 * (last - first) / len(values)
            yield MeasurementFault(
                "stuck",
                (trial.name,),
                (name,),
                f"{trial.name}: {name} stays at {level:.4g} from t = {trial.recording.time[first]:.4g} s for {(last - first) * dt:.2g} s "
                f"({share:.2g} % of its samples) while the others move",
                "leave this run or channel out, or record again",
            )
            break


def _drifting(trial: Trial) -> Iterator[MeasurementFault]:
    values = trial.recording.values
    columns = np.column_stack([np.ones(len(values)), np.linspace(-1, 1, len(values))])
    line = columns @ np.linalg.lstsq(columns, values, rcond=None)[0]
    share = np.sqrt(np.mean(line**2, axis=0) / np.maximum(np.mean((values - line) ** 2, axis=0), 1e-300))
    for channel, own in zip(trial.recording.channels, share, strict=True):
        if channel.quantity in AT_REST_ZERO and own > MOSTLY_DRIFT:
            yield MeasurementFault(
                "drift",
                (trial.name,),
                (channel.name,),
                f"{trial.name}: {channel.name} has an offset or drifts, by {own:.2g} times what it records",
                "take mean and trend off the column, or import the recording with its quiet lead-in, which does so",
            )


def variety_notes(trials: Sequence[Trial]) -> tuple[str, ...]:
    """Return what runs of one amplitude or one speed cannot tell, in sentences."""
    if not all(trial.scenario.track.parts for trial in trials):
        return ()
    heights = []
    for trial in trials:
        offsets = trial.simulator.model.wheel_offsets(trial.values)
        heights.append(float(np.ptp(trial.scenario.excitation(offsets).inputs[:, : len(offsets)])))
    return tuple(
        f"all runs have one {word}: lift-off, stops and friction cannot be told apart by them; add {advice}"
        for word, found, advice in (
            ("height of road", heights, "a run over a higher or lower hump"),
            ("speed", [trial.scenario.top_speed for trial in trials], "a run at another speed"),
        )
        if max(found) > 0 and max(found) <= (1 + ALIKE_SHARE) * min(found)
    )
