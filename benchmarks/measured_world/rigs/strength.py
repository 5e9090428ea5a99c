"""How clearly a hidden law shows: what it changes in the channels, beside what other parameters and instruments could change."""

from __future__ import annotations

from dataclasses import replace
from types import ModuleType

import numpy as np
from numpy.typing import NDArray

from benchmarks.measured_world.chain import Filter, Noise
from benchmarks.measured_world.rigs.cases import Rig, Run
from benchmarks.measured_world.rigs.recorder import record
from benchmarks.measured_world.rigs.signals import Signal, moments, sampled

Array = NDArray[np.float64]
STEP = 0.01
"""Relative change of a parameter, or of an input, by which its influence is found."""
LATER = 1e-3
"""By which an input is moved in time [s]."""


def strength(rig: Rig, family: ModuleType) -> dict[str, float]:
    """Return rms, over the noise of sensors and measured inputs, of what the hidden laws change under the same inputs: in all (`raw`), and
    what uncertain parameters, gains, offsets and delays cannot take off of it, to first order (`distinct`)."""
    changes, influences = [], []
    for run in rig.runs:
        look = Look(rig, family, run)
        now = look.channels(rig)
        changes.append(now - look.channels(replace(rig, hidden=())))
        influences.append(look.influences(now))
    change = np.concatenate(changes)
    shared = [np.concatenate([item[name] for item in influences]) for name in influences[0] if name != "late"]
    late = [np.concatenate([item["late"] * (i == own) for i, item in enumerate(influences)]) for own in range(len(rig.runs))]
    matrix = np.column_stack([*shared, *late])
    scale = np.linalg.norm(matrix, axis=0)
    matrix = matrix / np.where(scale > 0.0, scale, 1.0)
    left = change - matrix @ np.linalg.lstsq(matrix, change, rcond=None)[0]
    return {"raw": float(np.sqrt(np.mean(change**2))), "distinct": float(np.sqrt(np.mean(left**2)))}


class Look:
    """The channels of a run over the noise that sensors and the inputs' noise make in them, one behind the other, each about its mean."""

    def __init__(self, rig: Rig, family: ModuleType, run: Run) -> None:
        self.rig, self.family, self.run = rig, family, run
        self.inputs: dict[str, Signal] = family.drive(rig, run)
        self.motions, _ = family.respond(rig, run, self.inputs)
        found = record(rig, run, self.motions)
        self.noise = dict(found.sigma)
        if self.inputs:
            bare = replace(rig, hidden=())
            quiet, noisy = (record(bare, run, family.respond(bare, run, inputs)[0]).clean for inputs in (self.inputs, self._noisy()))
            for name, sigma in found.sigma.items():
                self.noise[name] = float(np.hypot(sigma, np.std(noisy[name] - quiet[name])))

    def channels(self, rig: Rig, inputs: dict[str, Signal] | None = None) -> Array:
        """Return the channels of another rig, or with other inputs."""
        if rig is self.rig and inputs is None:
            return self._over_noise(rig, self.motions)
        return self._over_noise(rig, self.family.respond(rig, self.run, inputs or self.inputs)[0])

    def influences(self, now: Array) -> dict[str, Array]:
        """Return what every uncertain parameter, every input's gain and offset, and a delay (`late`) change."""
        rig, found, t = self.rig, {}, moments(self.run.duration)
        for name, item in rig.quantities.items():
            if item.uncertain:
                other = replace(item, true=item.true * (1.0 + STEP))
                found[name] = self.channels(replace(rig, quantities={**rig.quantities, name: other})) - now
        for name, signal in self.inputs.items():
            values = signal.value(t)
            offset = STEP * float(np.std(values)) * np.clip(t / 0.5, 0.0, 1.0) ** 2
            found[f"{name} gain"] = self.channels(rig, {**self.inputs, name: sampled(values * (1.0 + STEP))}) - now
            found[f"{name} offset"] = self.channels(rig, {**self.inputs, name: sampled(values + offset)}) - now
        moved = tuple(replace(item, chain=replace(item.chain, delay=item.chain.delay + LATER)) for item in rig.channels)
        return found | {"late": self._over_noise(replace(rig, channels=moved), self.motions) - now}

    def _over_noise(self, rig: Rig, motions: dict[str, Array]) -> Array:
        clean = record(rig, self.run, motions).clean
        return np.concatenate([(values - np.mean(values)) / self.noise[name] for name, values in clean.items()])

    def _noisy(self) -> dict[str, Signal]:
        rng, recorder = np.random.default_rng([self.run.seed, 2]), self.rig.recorder
        low_pass = Filter(recorder.kind, recorder.order, recorder.cutoff)
        found = {}
        for channel in self.rig.inputs:
            values = self.inputs[channel.motion].value(moments(self.run.duration))
            noise = Noise(channel.chain.noise / np.sqrt(recorder.rate * recorder.finer / 2.0)).draw(values.shape, rng)
            found[channel.motion] = sampled(values + low_pass.apply(noise))
        return {**self.inputs, **found}
