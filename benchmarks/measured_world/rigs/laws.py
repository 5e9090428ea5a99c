"""Force laws of a joint in travel d and rate v, both positive in compression; values broadcast over moments."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Force = Callable[[Mapping[str, float], Array, Array, Array], Array]
CONTACT = 3e6
"""Stiffness of the bushings that meet once a play is used up [N/m]."""


@dataclass(frozen=True)
class Law:
    """A law: `force` of its values, d, v and an internal state z, and dz/dt where it has one.

    `replaces_dashpot`: the joint's own dashpot lies inside the law, in series; its damping is then the value `c`.
    """

    force: Force
    flow: Force | None = None
    replaces_dashpot: bool = False


def _nothing(p: Mapping[str, float], d: Array, v: Array, z: Array) -> Array:
    return 0.0 * d


def _cubic(p: Mapping[str, float], d: Array, v: Array, z: Array) -> Array:
    return p["k3"] * d**3


def _progressive(p: Mapping[str, float], d: Array, v: Array, z: Array) -> Array:
    return p["k"] * np.maximum(d - p["start"], 0.0)


def _stops(p: Mapping[str, float], d: Array, v: Array, z: Array) -> Array:
    return p["k"] * (np.maximum(d - p["clearance"], 0.0) - np.maximum(-d - p["rebound"], 0.0))


def _asymmetric(p: Mapping[str, float], d: Array, v: Array, z: Array) -> Array:
    return 2.0 * p["c"] / (1.0 + p["ratio"]) * np.where(v > 0.0, p["ratio"] * v, v)


def _quadratic(p: Mapping[str, float], d: Array, v: Array, z: Array) -> Array:
    return p["c2"] * v * np.abs(v)


def _loop(p: Mapping[str, float], d: Array, v: Array, z: Array) -> Array:
    return p["force"] * z


def _loop_flow(p: Mapping[str, float], d: Array, v: Array, z: Array) -> Array:
    return (v - p["beta"] * np.abs(v) * np.abs(z) * z - (1.0 - p["beta"]) * v * z**2) / p["travel"]


def _mount(p: Mapping[str, float], d: Array, v: Array, z: Array) -> Array:
    return p["k"] * (d - z)


def _play(p: Mapping[str, float], d: Array, v: Array, z: Array) -> Array:
    gap = d - z
    return CONTACT * (np.maximum(gap - p["gap"], 0.0) - np.maximum(-gap - p["gap"], 0.0))


def _spring(p: Mapping[str, float], d: Array, v: Array, z: Array) -> Array:
    return p["k"] * d


def _dashpot_flow(force: Force) -> Force:
    return lambda p, d, v, z: force(p, d, v, z) / p["c"]


LAWS: dict[str, Law] = {
    "none": Law(_nothing),
    "dry_friction": Law(_nothing),
    "directional_friction": Law(_nothing),
    "cubic_stiffness": Law(_cubic),
    "progressive_stiffness": Law(_progressive),
    "bump_stop": Law(_stops),
    "asymmetric_damping": Law(_asymmetric, replaces_dashpot=True),
    "quadratic_damping": Law(_quadratic),
    "hysteresis": Law(_loop, _loop_flow),
    "damper_mount": Law(_mount, _dashpot_flow(_mount), replaces_dashpot=True),
    "free_play": Law(_play, _dashpot_flow(_play), replaces_dashpot=True),
    "hidden_spring": Law(_spring),
}
"""The laws by name. Dry friction's force is set-valued: `mechanism` finds it from `slip_forces`."""


def slip_forces(kind: str, values: Mapping[str, float]) -> tuple[float, float] | None:
    """Return the friction while compressing and while extending [N]; None of a law without dry friction."""
    if kind == "dry_friction":
        return values["force"], values["force"]
    if kind == "directional_friction":
        return values["bump"], values["rebound"]
    return None
