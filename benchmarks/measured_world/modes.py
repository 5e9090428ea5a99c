"""What a calibration is to find: the true vehicle's natural modes and the ratios that recordings can tell."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray
from scipy import linalg, optimize

from benchmarks.hidden_effects.generator.system import base_system
from benchmarks.hidden_effects.generator.vehicles import layout

Array = NDArray[np.float64]
FOLLOWING = 201
"""Steps in which damping grows while poles are followed."""


def natural_modes(vehicle: str, parameters: Mapping[str, float]) -> list[dict[str, float]]:
    """Return the undamped frequency [Hz] and the damping ratio of every mode of the linear vehicle, ascending.

    The pins' constraints are eliminated by a basis of what they allow. The undamped frequency is that of M and K alone; `pole` is the
    magnitude of the damped system's eigenvalue [Hz] that it becomes as the damping grows, to which the ratio belongs.
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
    squares = linalg.eigh(K, M, eigvals_only=True)
    undamped = np.sqrt(np.sort(squares[squares > 1e-4]))
    return [
        {"frequency": float(w / (2.0 * np.pi)), "pole": float(abs(pole) / (2.0 * np.pi)), "damping_ratio": float(-pole.real / abs(pole))}
        for w, pole in zip(undamped, _followed(M, C, K, 1j * undamped), strict=True)
    ]


def _followed(M: Array, C: Array, K: Array, poles: NDArray[np.complex128]) -> NDArray[np.complex128]:
    """Return where the undamped poles [rad/s] go as the damping grows from nothing to C: each to the nearest of the next step, none
    twice."""
    zero, one = np.zeros_like(M), np.eye(len(M))
    for share in np.linspace(0.0, 1.0, FOLLOWING)[1:]:
        found = linalg.eigvals(np.block([[zero, one], [-linalg.solve(M, K), -share * linalg.solve(M, C)]]))
        candidates = found[found.imag >= 0.0]
        rows, columns = optimize.linear_sum_assignment(np.abs(poles[:, None] - candidates[None, :]))
        poles = candidates[columns[np.argsort(rows)]]
    return poles


def invariants(vehicle: str, p: Mapping[str, float]) -> dict[str, float]:
    """Return what hump recordings can determine: of the sedan all searched parameters, of the truck these ratios of its parameters."""
    if vehicle == "sedan2":
        return {name: p[name] for name in ("Lf", "mf", "mr", "IZ", "kf", "kr", "cf", "cr", "ktf", "ktr")}
    total = p["mT"] + p["mS"]
    found = {f"{kind}{i}/(mT + mS)": p[f"{kind}{i}"] / total for kind in ("m", "k", "c", "kt") for i in range(1, 6)}
    found["b7/(mT + mS)"] = (p["L1h"] - p["b1"]) / total
    found["b6*mS/(mT + mS)"] = p["b6"] * p["mS"] / total
    return found
