"""Effects in a suspension; d and v are its travel [m] and rate [m/s] in compression from static equilibrium, f adds to k d + c v."""

from __future__ import annotations

from benchmarks.hidden_effects.generator import laws
from benchmarks.hidden_effects.generator.effects.kind import EffectKind, Value, Values, suspensions
from benchmarks.hidden_effects.generator.setup import Setup


def _dry(setup: Setup, place: str, p: Values) -> None:
    setup.suspension(place).dry += p["force"]


def _cubic(setup: Setup, place: str, p: Values) -> None:
    setup.add_law(place, laws.CUBIC, p["k3"])


def _progressive(setup: Setup, place: str, p: Values) -> None:
    setup.add_law(place, laws.PROGRESSIVE, p["k"], p["start"])


def _stop(setup: Setup, place: str, p: Values) -> None:
    setup.add_law(place, laws.STOPS, p["k"], p["clearance"], p["rebound"])


def _asymmetric(setup: Setup, place: str, p: Values) -> None:
    share = (1.0 - p["ratio"]) / (1.0 + p["ratio"])
    setup.add_law(place, laws.ABSOLUTE_DAMPING, -share * setup.suspension(place).c)


def _quadratic(setup: Setup, place: str, p: Values) -> None:
    setup.add_law(place, laws.QUADRATIC_DAMPING, p["c2"])


def _hysteresis(setup: Setup, place: str, p: Values) -> None:
    setup.add_law(place, laws.BOUC_WEN, p["force"], p["travel"], p["beta"], states=(0.0,))


def _relaxation(setup: Setup, place: str, p: Values) -> None:
    setup.add_law(place, laws.MAXWELL, p["k"], p["time"], states=(0.0,))


def _damper_mount(setup: Setup, place: str, p: Values) -> None:
    if p["time"] == 0.0:
        return
    element = setup.suspension(place)
    setup.add_law(place, laws.MAXWELL, element.c / p["time"], p["time"], states=(0.0,))
    element.c = 0.0


def _free_play(setup: Setup, place: str, p: Values) -> None:
    if p["play"] > 0.0:
        setup.add_law(place, laws.FREE_PLAY, setup.suspension(place).c, p["play"], states=(0.0,))


SUSPENSION = (
    EffectKind(
        "dry_friction", "f = force sign(v) while slipping; any abs(f) <= force that keeps v = 0 while sticking", suspensions,
        (Value("force", "N", "force at which it slips", (0.01, 0.03), (0.05, 0.12), "load", 0.0),), _dry,
    ),
    EffectKind(
        "cubic_stiffness", "f = k3 d^3", suspensions,
        (Value("k3", "N/m^3", "cubic stiffness", (0.1, 0.3), (0.6, 2.0), "k/d2", 0.0),), _cubic,
    ),
    EffectKind(
        "progressive_stiffness", "f = k max(d - start, 0)", suspensions,
        (
            Value("k", "N/m", "stiffness added beyond start", (0.1, 0.25), (0.6, 1.5), "k", 0.0),
            Value("start", "m", "travel in bump where it joins in", (0.1, 0.4), (0.1, 0.4), "d"),
        ), _progressive,
    ),
    EffectKind(
        "bump_stop", "f = k (max(d - clearance, 0) - max(-d - rebound, 0))", suspensions,
        (
            Value("k", "N/m", "stiffness of the stops", (3.0, 8.0), (3.0, 8.0), "k", 0.0),
            Value("clearance", "m", "travel to the stop in bump", (0.6, 0.75), (0.3, 0.55), "d"),
            Value("rebound", "m", "travel to the stop in rebound", (0.8, 1.0), (0.4, 0.8), "d"),
        ), _stop,
    ),
    EffectKind(
        "asymmetric_damping", "damping 2 c ratio/(1 + ratio) in bump and 2 c/(1 + ratio) in rebound instead of c: f = -c (1 - "
        "ratio)/(1 + ratio) abs(v)", suspensions,
        (Value("ratio", "-", "damping in bump over that in rebound", (0.7, 0.85), (0.2, 0.5), neutral=1.0),), _asymmetric,
    ),
    EffectKind(
        "quadratic_damping", "f = c2 v abs(v)", suspensions,
        (Value("c2", "N s^2/m^2", "quadratic damping", (0.1, 0.25), (0.6, 2.0), "c/v", 0.0),), _quadratic,
    ),
    EffectKind(
        "hysteresis", "f = force z, travel z' = v - beta abs(v) abs(z) z - (1 - beta) v z^2 (Bouc-Wen, exponent 2)", suspensions,
        (
            Value("force", "N", "force of the developed loop", (0.01, 0.03), (0.05, 0.12), "load", 0.0),
            Value("travel", "m", "travel over which the loop develops", (0.05, 0.3), (0.05, 0.3), "d"),
            Value("beta", "-", "share of the loss that follows abs(v)", (0.5, 0.8), (0.5, 0.8)),
        ), _hysteresis,
    ),
    EffectKind(
        "relaxation", "f = k (d - y), time y' = d - y: a spring in series with a dashpot k time", suspensions,
        (
            Value("k", "N/m", "stiffness of the series spring", (0.1, 0.25), (0.6, 2.0), "k", 0.0),
            Value("time", "s", "relaxation time", (0.02, 0.2), (0.02, 0.2)),
        ), _relaxation,
    ),
    EffectKind(
        "damper_mount", "f = c y' = k (d - y) in place of c v, k = c/time: the dashpot stands on a spring", suspensions,
        (Value("time", "s", "damping over the stiffness of the mount", (0.001, 0.002), (0.006, 0.03), neutral=0.0),), _damper_mount,
    ),
    EffectKind(
        "damper_free_play", "the damper sits in worn eyes: its force c v acts only while the play is closed in the direction of "
        "motion; in between it does not move", suspensions,
        (Value("play", "m", "whole free play of the damper", (0.01, 0.04), (0.15, 0.5), "d", 0.0),), _free_play,
    ),
)  # fmt: skip
