"""How good the calibrated vehicles are: against the truth's frequencies and invariants, and on a road they have not seen."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from benchmarks.paper_study.fits import Fit
from benchmarks.paper_study.recordings import Rig
from vehgen.calibrate.validation import ChannelComparison, Validation, validate
from vehgen.fit.trial import Trial, load_trials

Array = np.ndarray


@dataclass(frozen=True)
class Judgement:
    """One vehicle beside the truth.

    `frequencies` [Hz] by mode; `invariants` relative errors of what hump data can tell, by name; `validation` the unseen road.
    """

    name: str
    frequencies: dict[str, float]
    invariants: dict[str, float]
    validation: Validation

    def channel(self, name: str) -> ChannelComparison:
        """Return one channel of the unseen road."""
        return next(item for item in self.validation.channels if item.channel == name)

    def band_errors(self, sensors: Sequence[str]) -> Array:
        """Return relative band-RMS errors of accelerations, `shape (len(sensors), n_bands)`."""
        return np.array([self.channel(f"{name}_az").errors for name in sensors])


def judge(rig: Rig, fits: Sequence[Fit], truth: dict[str, float], unseen: Path) -> list[Judgement]:
    """Judge every fit; the first judgement is that of the true parameters themselves, in vehgen's model."""
    trial = load_trials([unseen])[0]
    named = [("truth", truth), *((item.method.name, item.values) for item in fits)]
    return [
        Judgement(name, rig.system(values).frequencies(), errors(rig, values, truth), validate(trial.run.vehicle, [_with(trial, values)]))
        for name, values in named
    ]


def _with(trial: Trial, values: dict[str, float]) -> Trial:
    return replace(trial, values=trial.values | {name: values[name] for name in trial.values if name in values})


def invariants(rig: Rig, p: dict[str, float]) -> dict[str, float]:
    """Return what hump data can tell: for the sedan all parameters, for the truck the identifiable combinations."""
    if rig.kind == "sedan":
        return {name: p[name] for name in ("Lf", "IZ", "mf", "mr", "kf", "kr", "cf", "cr", "ktf", "ktr")}
    total = p["mT"] + p["mS"]
    found = {f"{kind}{i}/(mT+mS)": p[f"{kind}{i}"] / total for kind in ("m", "k", "c", "kt") for i in range(1, 6)}
    b7, mu = 3.75 - p["b1"], p["mT"] * p["mS"] / total
    found["b7/(mT+mS)"] = b7 / total
    found["b6 mS/(mT+mS)"] = p["b6"] * p["mS"] / total
    # with masses over mT, as the unidentifiable directions are; b7^2 is that of the unit tractor mass
    found["JT/(mT+mS)"] = (p["IT"] + p["mT"] * b7**2 + mu * p["a1"] ** 2) / total
    found["JS/(mT+mS)"] = (p["IS"] + p["mS"] * p["b6"] ** 2 + mu * p["a2"] ** 2) / total
    return found


def errors(rig: Rig, values: dict[str, float], truth: dict[str, float]) -> dict[str, float]:
    """Return the relative errors of the invariants."""
    right = invariants(rig, truth)
    return {name: value / right[name] - 1 for name, value in invariants(rig, values).items()}


def frequency_errors(judgement: Judgement, truth: Judgement) -> dict[str, float]:
    """Return the relative errors of the natural frequencies by mode."""
    return {name: value / truth.frequencies[name] - 1 for name, value in judgement.frequencies.items()}
