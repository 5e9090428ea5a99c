"""Responses as a recorder keeps them: every channel passes its chain of acquisition before it is sampled.

A linear vehicle whose channels share one chain answers a filtered excitation as the chain filters its answer: the excitation is filtered,
once for a whole population. Otherwise the kernel keeps enough of its steps, and a decimating FIR filter is applied to every channel. The
vehicle rests before the run begins; a chain that looks ahead sees the excitation go on beyond the run's end.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import lru_cache

import numpy as np
import scipy
from numpy.typing import NDArray

from vehgen.codegen import Excitation, Kernel, KernelResult
from vehgen.codegen.decimation import Phases, decimate
from vehgen.measure.acquisition import AcquisitionChain
from vehgen.simulate.last_used import LastUsed
from vehgen.simulate.nearby import Drive, nearby_excitation
from vehgen.simulate.scenario import Scenario

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]
Driven = Callable[[int], Excitation]
"""What drives a population, so many samples longer than its scenario."""
LEAST_RATIO = 5
"""Kept steps per sample, at least, of what a FIR filter decimates ..."""
LEAST_RATE = 500.0
"""... and kept steps per second [Hz], where the internal step is as short."""
_FILTERED = LastUsed[Excitation](lambda item: item.nbytes)


def assumed_chains(scenario: Scenario, channels: Sequence[str]) -> tuple[AcquisitionChain, ...]:
    """Return the chain of each channel by name at the scenario's sampling rate, an unknown one as it is assumed to be."""
    rate = 1 / (scenario.dt * scenario.decimation)
    return tuple(_assumed(scenario.chain(name), rate) for name in channels)


@lru_cache(maxsize=64)
def _assumed(chain: AcquisitionChain, rate: float) -> AcquisitionChain:
    return chain.assumed(rate)


@lru_cache(maxsize=64)
def _filtering(chain: AcquisitionChain) -> AcquisitionChain:
    return chain.filtering()


def _filters(scenario: Scenario, channels: Sequence[str]) -> tuple[AcquisitionChain, ...]:
    """Return what filters each channel by name: chains that compare equal do the same."""
    return tuple(_filtering(chain) for chain in assumed_chains(scenario, channels))


def channel_factors(scenario: Scenario, channels: Sequence[str], frequency: Array) -> Complex:
    """Return what the chains make of spectral lines: complex factors `shape (n, n_channels)` at frequencies `shape (n,)` [Hz]."""
    chains = _filters(scenario, channels)
    known = {chain: chain.response(frequency) for chain in dict.fromkeys(chains)}
    return np.column_stack([known[chain] for chain in chains]) if chains else np.ones((len(frequency), 0), dtype=np.complex128)


def kept_samples(scenario: Scenario, channels: Sequence[str], nonlinear: bool) -> int:
    """Return how many samples of every channel a run holds in memory."""
    chains = set(_filters(scenario, channels))
    fine = any(not chain.is_point_sample for chain in chains) and (nonlinear or len(chains) > 1)
    return len(scenario.time) // (kept_stride(scenario) if fine else scenario.decimation) + 1


def acquire(
    kernel: Kernel,
    parameters: Array,
    scenario: Scenario,
    offsets: Array,
    threads: int | None = None,
    nearby: Sequence[Drive] = (),
) -> KernelResult:
    """Run a population whose axles stand alike, or drives that hardly differ, and return what their recorders keep.

    Parameters
    ----------
    kernel
        The vehicle's; its channels find their chains in the scenario by their names.
    parameters
        `shape (n_individuals, n_parameters)`.
    scenario
        The run.
    offsets
        Each axle's distance behind the first to arrive `shape (n_axles,)` [m].
    threads
        How many cores to use (default: all).
    nearby
        Drives that hardly differ: the first individual is run over `scenario`, each other one as one of these.
    """
    found = _acquired(kernel, parameters, scenario, offsets, threads, nearby)
    return replace(found, responses=found.responses[:, scenario.skipped :]) if scenario.skipped else found


def _acquired(
    kernel: Kernel, parameters: Array, scenario: Scenario, offsets: Array, threads: int | None, nearby: Sequence[Drive]
) -> KernelResult:
    chains = _filters(scenario, [channel.name for channel in kernel.model.channels])
    distinct, begin = set(chains), initial_states(scenario, len(parameters), [item for item, _ in nearby])

    def excitation(ahead: int) -> Excitation:
        """Return what drives the individuals, so many samples longer than the scenario."""
        longer = extended(scenario, ahead)
        drives = [(extended(item, ahead), behind) for item, behind in nearby]
        return nearby_excitation(longer, offsets, drives) if drives else longer.excitation(offsets)

    if all(chain.is_point_sample for chain in distinct):
        return kernel.run(parameters, excitation(0), scenario.decimation, begin, threads)
    if len(distinct) == 1 and not kernel.source.nonlinear and begin is None and not nearby:
        filtered, ahead = _filtered_input(scenario, excitation, chains[0])
        result = kernel.run(parameters, filtered, scenario.decimation, threads=threads)
        return replace(result, responses=result.responses[:, ahead:]) if ahead else result
    return _filtered_output(kernel, parameters, scenario, excitation, chains, begin, threads)


def initial_states(scenario: Scenario, count: int, nearby: Sequence[Scenario] = ()) -> Array | None:
    """Return the state in which every individual begins, `shape (count, 2 n_dof)`, or each of those nearby; None at rest."""
    if scenario.initial is None:
        return None
    if not nearby:
        return np.repeat(scenario.initial[None], count, axis=0)
    return np.array([scenario.initial if item.initial is None else item.initial for item in (scenario, *nearby)])


def extended(scenario: Scenario, samples: int) -> Scenario:
    """Return the scenario with so many samples more at its end."""
    return replace(scenario, duration=scenario.duration + samples * scenario.decimation * scenario.dt) if samples else scenario


def keeps_what_recorders_keep(kernel: Kernel, scenario: Scenario) -> bool:
    """Whether the samples that a linear kernel keeps, from rest, are those of the recorders: all channels pass one chain."""
    chains = set(_filters(scenario, [channel.name for channel in kernel.model.channels]))
    return len(chains) == 1 and not kernel.source.nonlinear and scenario.initial is None


def acquired_excitation(kernel: Kernel, scenario: Scenario, offsets: Array) -> tuple[Excitation, int]:
    """Return what drives such a kernel, and its first sample that the recorders keep (see :func:`keeps_what_recorders_keep`)."""
    chain = _filters(scenario, [kernel.model.channels[0].name])[0]
    if chain.is_point_sample:
        return scenario.excitation(offsets), scenario.skipped
    filtered, ahead = _filtered_input(scenario, lambda samples: extended(scenario, samples).excitation(offsets), chain)
    return filtered, ahead + scenario.skipped


def _filtered_input(scenario: Scenario, excitation: Driven, chain: AcquisitionChain) -> tuple[Excitation, int]:
    """Return the filtered excitation, and from how many samples before the run: as many as the chain looks ahead."""
    ahead = math.ceil(max(-chain.taps(scenario.dt)[0], 0) / scenario.decimation)
    raw = excitation(ahead)
    lead, last = ahead * scenario.decimation, len(scenario.time)
    return _FILTERED.find((id(raw), chain, lead, last), raw, lambda: _filtered(raw, chain, lead, last)), ahead


def _filtered(raw: Excitation, chain: AcquisitionChain, lead: int, last: int) -> Excitation:
    first, taps = chain.taps(raw.dt)
    columns = (_convolved(item, taps, -lead - first, lead + last) for item in (raw.inputs, raw.rates, raw.forces))
    return Excitation(raw.dt, *columns)


def _convolved(signal: Array, taps: Array, start: int, count: int) -> Array:
    """Return numbers `start` to `start + count` of the convolution of signals `shape (n, k)`, zero before their beginning.

    A hump is short: of each signal only what lies between its first and its last number is transformed.
    """
    found, moving = np.zeros((count, signal.shape[1])), signal != 0.0
    begins, ends = moving.argmax(axis=0).tolist(), (len(signal) - moving[::-1].argmax(axis=0)).tolist()
    columns = [k for k, begin in enumerate(begins) if moving[begin, k]]
    if not columns:
        return found
    parts = np.zeros((len(columns), max(ends[k] - begins[k] for k in columns)))
    for part, k in zip(parts, columns, strict=True):
        part[: ends[k] - begins[k]] = signal[begins[k] : ends[k], k]
    n = parts.shape[1] + len(taps) - 1
    size = scipy.fft.next_fast_len(n, real=True)
    parts = scipy.fft.irfft(scipy.fft.rfft(parts, size) * _spectrum(taps.tobytes(), size), size)[:, :n]
    for part, k in zip(parts, columns, strict=True):
        low, high = max(begins[k], start), min(begins[k] + n, start + count)
        if low < high:
            found[low - start : high - start, k] = part[low - begins[k] : high - begins[k]]
    return found


@lru_cache(maxsize=64)
def _spectrum(taps: bytes, size: int) -> Complex:
    return np.asarray(scipy.fft.rfft(np.frombuffer(taps), size), dtype=np.complex128)


def kept_stride(scenario: Scenario) -> int:
    """Return every how many steps must be kept for a FIR filter to decimate: few enough, and a whole number of them a sample."""
    most = min(scenario.decimation / LEAST_RATIO, 1 / (LEAST_RATE * scenario.dt) * (1 + 1e-9))
    fitting = [stride for stride in range(1, scenario.decimation + 1) if scenario.decimation % stride == 0 and stride <= most]
    return max(fitting, default=1)


def _filtered_output(
    kernel: Kernel,
    parameters: Array,
    scenario: Scenario,
    excitation: Driven,
    chains: Sequence[AcquisitionChain],
    begin: Array | None,
    threads: int | None,
) -> KernelResult:
    """Run with kept steps between the samples and decimate every channel by its own chain."""
    stride = kept_stride(scenario)
    phases, ahead = _phases(tuple(chains), scenario.dt * stride, scenario.decimation // stride)
    result = kernel.run(parameters, excitation(ahead), stride, begin, threads)
    count = (len(scenario.time) - 1) // scenario.decimation + 1
    return replace(result, responses=decimate(result.responses, phases, count, threads))


@lru_cache(maxsize=64)
def _phases(chains: tuple[AcquisitionChain, ...], spacing: float, ratio: int) -> tuple[Phases, int]:
    """Return the channels' filters of signals `spacing` [s] apart, and how many samples they look ahead."""
    filters = [chain.taps(spacing) for chain in chains]
    return Phases.of(filters, ratio), math.ceil(max(0, *(-first for first, _ in filters)) / ratio)
