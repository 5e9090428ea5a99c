"""A rig's recorder: anti-alias low-pass, late channels, gains, offsets, noise and resolution; what is drawn of each."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from benchmarks.measured_world.chain import RATE, Filter, Noise, sample
from benchmarks.measured_world.rigs.cases import Chain, Channel, Recorder, Rig, Run

Array = NDArray[np.float64]
BEFORE = 0.3
"""Known of a rig before it is released or driven [s]."""


@dataclass(frozen=True)
class Recording:
    """A recording: t [s] and channels, the same without noise and rounding, the noise's standard deviations, inputs with their t."""

    t: Array
    channels: dict[str, Array]
    clean: dict[str, Array]
    sigma: dict[str, float]
    input_t: Array
    inputs: dict[str, Array]


def draw_recorder(rates: tuple[float, ...], rng: np.random.Generator) -> Recorder:
    """Return a recorder whose low-pass suits its rate; one in three is stated in the run files."""
    rate = float(rng.choice(rates))
    kind, order = str(rng.choice(["butterworth", "bessel"])), int(rng.choice([2, 4, 6, 8]))
    return Recorder(rate, 4, kind, order, float(rng.uniform(0.35, 0.46)) * rate, bool(rng.random() < 1.0 / 3.0))


def draw_chain(gain: float, offset: float, delay: float, noise: float, resolution: float, rng: np.random.Generator) -> Chain:
    """Return a chain: a gain off by a third of `gain` to `gain`, an offset and a delay up to those given, noise and resolution within
    a factor of two of those given."""
    return Chain(
        1.0 + float(rng.uniform(gain / 3.0, gain) * rng.choice([-1.0, 1.0])),
        float(rng.uniform(-offset, offset)),
        float(rng.uniform(-delay, delay)),
        noise * float(2.0 ** rng.uniform(-1.0, 1.0)),
        resolution * float(2.0 ** rng.uniform(-1.0, 1.0)),
    )


def record(rig: Rig, run: Run, motions: Mapping[str, Array]) -> Recording:
    """Return the recording of motions at RATE from t = 0 on, `shape (samples,)` each."""
    rng = np.random.default_rng([rig.seed, run.seed])
    recorder = rig.recorder
    low_pass = Filter(recorder.kind, recorder.order, recorder.cutoff)
    span = run.duration - 2.0 * BEFORE
    t = np.arange(int(span * recorder.rate) + 1) / recorder.rate
    input_t = np.arange(int(span * recorder.rate * recorder.finer) + 1) / (recorder.rate * recorder.finer)
    channels, clean, sigma, inputs = {}, {}, {}, {}
    for channel in rig.channels:
        clean[channel.name], noise = _read(channel, motions, low_pass, t + run.late, recorder.rate, rng)
        channels[channel.name] = _rounded(clean[channel.name] + noise, channel.chain.resolution)
        sigma[channel.name] = float(np.hypot(np.std(noise), channel.chain.resolution / np.sqrt(12.0)))
    for channel in rig.inputs:
        values, noise = _read(channel, motions, low_pass, input_t, recorder.rate * recorder.finer, rng)
        inputs[channel.name] = _rounded(values + noise, channel.chain.resolution)
    return Recording(t, channels, clean, sigma, input_t, inputs)


def _read(
    channel: Channel, motions: Mapping[str, Array], low_pass: Filter, t: Array, rate: float, rng: np.random.Generator
) -> tuple[Array, Array]:
    """Return a channel's readings at moments t without noise, and its noise."""
    chain, motion = channel.chain, motions[channel.motion]
    before = np.full(round(BEFORE * RATE), 0.0 if channel.quantity == "acceleration" else motion[0])
    values = np.concatenate([before, motion])
    read = channel.sign * (chain.gain * sample(low_pass.apply(values), -BEFORE, t - chain.delay) + chain.offset)
    noise = low_pass.apply(Noise(chain.noise / np.sqrt(rate / 2.0)).draw(values.shape, rng))
    return read, sample(noise, -BEFORE, t)


def _rounded(values: Array, step: float) -> Array:
    return values if step == 0.0 else np.asarray(np.round(values / step) * step)
