"""What a rig's case consists of: what its file states and what is true, its runs, what records them, and what is hidden."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from benchmarks.measured_world.chain import RATE

RANGE = (0.6, 1.5)
"""Of an uncertain parameter, as shares of what the vehicle file states."""


@dataclass(frozen=True)
class Quantity:
    """A parameter of a rig [SI]: what it is and what the vehicle file says, with the range where it is uncertain."""

    true: float
    stated: float
    unit: str
    meaning: str
    uncertain: bool = False


@dataclass(frozen=True)
class Chain:
    """A measuring chain: reading = gain*truth(t - delay) + offset, white noise [unit, rms of samples], resolution [unit]."""

    gain: float
    offset: float
    delay: float
    noise: float
    resolution: float


@dataclass(frozen=True)
class Channel:
    """A measured column: which motion of the rig it reads, how a run file describes its sensor, its unit and the sign of its readings."""

    name: str
    motion: str
    sensor: str
    quantity: str
    unit: str
    chain: Chain
    sign: int = 1


@dataclass(frozen=True)
class Run:
    """A run: its plan (numbers of its excitation, or of a release), how wrong a release was read, and how late after it the recording
    begins [s]."""

    name: str
    kind: str
    duration: float
    plan: Mapping[str, float]
    errors: Mapping[str, float] = field(default_factory=dict)
    late: float = 0.0
    seed: int = 0


@dataclass(frozen=True)
class Hidden:
    """A hidden law at a place. `accepted`: other laws that describe it as well, with their values."""

    law: str
    place: str
    values: Mapping[str, float]
    listed: bool = True
    accepted: Mapping[str, Mapping[str, float]] = field(default_factory=dict)


@dataclass(frozen=True)
class Recorder:
    """One recorder: response samples at `rate` [Hz], inputs at `rate*finer`, one anti-alias low-pass for both, and whether run files
    state it."""

    rate: float
    finer: int
    kind: str
    order: int
    cutoff: float
    declared: bool


@dataclass(frozen=True)
class Rig:
    """A case. `inputs` are measured motions or forces that drive the rig, `numbers` what else its family knows of it [SI]."""

    name: str
    family: str
    quantities: Mapping[str, Quantity]
    numbers: Mapping[str, float]
    inputs: tuple[Channel, ...]
    channels: tuple[Channel, ...]
    recorder: Recorder
    runs: tuple[Run, ...]
    seed: int
    hidden: tuple[Hidden, ...] = ()
    strength: Mapping[str, Any] | None = None

    def true(self, name: str) -> float:
        """Return a parameter's true value [SI]."""
        return self.quantities[name].true

    def law_at(self, place: str) -> dict[str, Any]:
        """Return the law of a joint at a place, as arguments of a Joint."""
        for hidden in self.hidden:
            if hidden.place == place:
                return {"law": hidden.law, "values": hidden.values}
        return {}


def uncertain(stated: float, spread: float, unit: str, meaning: str, rng: np.random.Generator) -> Quantity:
    """Return a parameter that the file states with an error of up to `spread`, relative, and a range."""
    stated = float(f"{stated:.3g}")
    return Quantity(stated * (1.0 + float(rng.uniform(-spread, spread))), stated, unit, meaning, True)


def weighed(stated: float, error: float, unit: str, meaning: str, rng: np.random.Generator) -> Quantity:
    """Return a parameter that was measured to `error`, relative, one standard deviation; the file gives no range."""
    stated = float(f"{stated:.4g}")
    return Quantity(stated * (1.0 + float(np.clip(rng.normal(0.0, error), -2.0 * error, 2.0 * error))), stated, unit, meaning)


def with_true_file(rig: Rig) -> Rig:
    """Return the rig with a vehicle file that states what is true."""
    return replace(rig, quantities={name: replace(item, stated=item.true) for name, item in rig.quantities.items()})


def with_exact_inputs(rig: Rig) -> Rig:
    """Return the rig with point samples that have noise and resolution but no other error, inputs known exactly, releases as stated."""
    exact = Chain(1.0, 0.0, 0.0, 0.0, 0.0)
    folded = np.sqrt(rig.recorder.rate / RATE)
    chains = [replace(item.chain, gain=1.0, offset=0.0, delay=0.0, noise=item.chain.noise * folded) for item in rig.channels]
    channels = tuple(replace(item, chain=chain) for item, chain in zip(rig.channels, chains, strict=True))
    return replace(
        rig,
        inputs=tuple(replace(item, chain=exact) for item in rig.inputs),
        channels=channels,
        runs=tuple(replace(run, late=0.0, errors=dict.fromkeys(run.errors, 0.0)) for run in rig.runs),
        recorder=replace(rig.recorder, kind="none", declared=False),
    )
