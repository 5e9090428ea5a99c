"""What a calibration is to find: the true vehicle's natural modes and the ratios that recordings can tell."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray
from scipy import linalg

from benchmarks.hidden_effects.generator.system import base_system
from benchmarks.hidden_effects.generator.vehicles import layout

Array = NDArray[np.float64]


def natural_modes(vehicle: str, parameters: Mapping[str, float]) -> list[dict[str, float]]:
    """Return the undamped frequency [Hz] and the damping ratio of every mode of the linear vehicle, ascending.

    The pins' constraints are eliminated by a basis of what they allow. The undamped frequency is that of M and K alone; `pole` is the
    magnitude of the damped system's eigenvalue [Hz] that belongs to the ratio.
    """
    system = base_system(layout(vehicle, parameters))
    n = len(system.coordinates)
    K, C = np.zeros((n, n)), np.zeros((n, n))
    for element in system.elements.values():
        row = system.row(element.terms)
        K += element.k * np.outer(row, row)
        C += element.c * np.outer(row, row)
    allowed = linalg.null_space(system.constraint_matrix()) if system.constraints else np.eye(n)
    M, C, K = (allowed.T @ matrix @ allowed for matrix in (system.mass_matrix(), C, K))
    undamped = np.sqrt(np.maximum(linalg.eigh(K, M, eigvals_only=True), 0.0)) / (2.0 * np.pi)
    undamped = np.sort(undamped[undamped > 1e-3])
    zero, one = np.zeros_like(M), np.eye(len(M))
    poles = linalg.eigvals(np.block([[zero, one], [-linalg.solve(M, K), -linalg.solve(M, C)]]))
    poles = poles[np.abs(poles) > 2.0 * np.pi * 1e-3]
    upper = np.sort_complex(poles[poles.imag > 1e-9])
    ordered = upper[np.argsort(np.abs(upper))]
    if len(ordered) != len(undamped):
        raise ValueError(f"{vehicle} has an overdamped mode: {len(ordered)} pairs of poles, {len(undamped)} frequencies")
    return [
        {"frequency": float(hz), "pole": float(abs(pole) / (2.0 * np.pi)), "damping_ratio": float(-pole.real / abs(pole))}
        for hz, pole in zip(undamped, ordered, strict=True)
    ]


def invariants(vehicle: str, p: Mapping[str, float]) -> dict[str, float]:
    """Return what hump recordings can determine: of the sedan all searched parameters, of the truck these ratios of its parameters."""
    if vehicle == "sedan2":
        return {name: p[name] for name in ("Lf", "mf", "mr", "IZ", "kf", "kr", "cf", "cr", "ktf", "ktr")}
    total = p["mT"] + p["mS"]
    found = {f"{kind}{i}/(mT + mS)": p[f"{kind}{i}"] / total for kind in ("m", "k", "c", "kt") for i in range(1, 6)}
    found["b7/(mT + mS)"] = (p["L1h"] - p["b1"]) / total
    found["b6*mS/(mT + mS)"] = p["b6"] * p["mS"] / total
    return found
