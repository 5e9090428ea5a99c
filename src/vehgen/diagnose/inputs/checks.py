"""Are these recordings what they are said to be? Checks of recordings before any fit, and of the gap after the base fit.

A clipped sensor, two phones exchanged, a turned axis or a wrong wheelbase leave a gap that some effect of the library closes in part: the
diagnosis would name it with confidence. What is wrong with the inputs is therefore looked for first (see also mistakes.py).
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from vehgen.diagnose.inputs.finding import Finding
from vehgen.diagnose.inputs.mistakes import Suspicion, suspect, unrelated_recording
from vehgen.fit.trial import Trial

if TYPE_CHECKING:
    from vehgen.diagnose.detect.detection import Detection

Array = NDArray[np.float64]
CLIPPED_SAMPLES_AT_EXTREME = 4
"""So many samples at an extreme, and so many times as many as at the next value, count as clipping."""
STUCK = 0.3
"""A channel that does not change for this long [s] while the others move is stuck."""
MOVING_SHARE = 0.5
"""The others move where their RMS is at least this share of that of their whole run."""
COARSE_RESOLUTION = 0.1
"""A channel whose smallest change is more than this share of its RMS is too coarse to be called stuck."""
SAME = 0.1
"""Amplitudes and speeds within this share of one another are one."""
CLEAR = 0.25
"""A mistake that leaves this share of what it may is not compared with others."""


def check_inputs(trials: Sequence[Trial]) -> tuple[Finding, ...]:
    """Return what recordings and runs show by themselves: clipped and stuck channels (fatal), one amplitude or speed only (notes)."""
    return (*(item for trial in trials for item in (*_clipped(trial), *_stuck(trial))), *_variety(trials))


def explain_gap(detection: Detection) -> tuple[Finding, ...]:
    """Return what is wrong with labels, signs, axle positions or the vehicle, where that explains the gap; nothing where it does not.

    To be called when the base model is above the noise floor. Takes a few refits of the base model.
    """
    accepted: list[Suspicion] = []
    for item in suspect(detection):
        if item.left <= CLEAR * item.limit:
            return item.findings
        if item.left <= item.limit:
            accepted.append(item)
    stranger = unrelated_recording(detection)
    if not accepted and stranger.left <= stranger.limit:
        accepted.append(stranger)
    return min(accepted, key=lambda item: item.left).findings if accepted else ()


def _clipped(trial: Trial) -> Iterator[Finding]:
    for name, values in zip(trial.channels, trial.recording.values.T, strict=True):
        levels, count = [], 0
        for extreme, side in ((values.max(), values), (values.min(), -values)):
            at = side == side.max()
            inner = side[~at]
            touching = bool((at[1:] & at[:-1]).any())
            if (
                extreme != 0
                and touching
                and at.sum() >= CLIPPED_SAMPLES_AT_EXTREME * max(1, int((inner == inner.max(initial=-np.inf)).sum()))
            ):
                levels.append(f"{extreme:.4g}")
                count += int(at.sum())
        if levels:
            yield Finding(
                "clipped",
                trial.name,
                name,
                f"{trial.name}: {name} is clipped at {' and '.join(levels)} in {count} samples ({100 * count / len(values):.2g} %): "
                "record again with a sensor of larger range, at a lower speed or over a lower hump, or leave this run out",
                True,
            )


def _stuck(trial: Trial) -> Iterator[Finding]:
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
            yield Finding(
                "stuck",
                trial.name,
                name,
                f"{trial.name}: {name} stays at {level:.4g} from t = {trial.recording.time[first]:.4g} s for {(last - first) * dt:.2g} s "
                f"({share:.2g} % of its samples) while the others move: leave this run or channel out, or record again",
                True,
            )
            break


def _variety(trials: Sequence[Trial]) -> Iterator[Finding]:
    if not trials[0].run.vehicle.axles:
        return
    heights = []
    for trial in trials:
        offsets = trial.simulator.model.wheel_offsets(trial.values)
        heights.append(float(np.ptp(trial.scenario.excitation(offsets).inputs[:, : len(offsets)])))
    for kind, word, found, advice in (
        ("one_amplitude", "height of road", heights, "a run over a higher or lower hump"),
        ("one_speed", "speed", [trial.scenario.top_speed for trial in trials], "a run at another speed"),
    ):
        if max(found) > 0 and max(found) <= (1 + SAME) * min(found):
            yield Finding(
                kind,
                None,
                None,
                f"all runs have one {word}: lift-off, stops and friction cannot be told apart by them; add {advice}",
                False,
            )


__all__ = ["Finding", "check_inputs", "explain_gap"]
