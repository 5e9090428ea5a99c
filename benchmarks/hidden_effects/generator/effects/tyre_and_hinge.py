"""Effects in tyres and the fifth wheel. A tyre's d is road less axle height [m]; the hinge turns by theta_front - theta_rear [rad]."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from benchmarks.hidden_effects.generator import laws
from benchmarks.hidden_effects.generator.effects.kind import EffectKind, Value, Values, axles_and_all, everywhere, pins, suspensions
from benchmarks.hidden_effects.generator.setup import Setup
from benchmarks.hidden_effects.generator.system import Law

Array = NDArray[np.float64]


def _liftoff(setup: Setup, place: str, p: Values) -> None:
    static = setup.system.static_forces()
    for axle in setup.axles(place):
        setup.tyre(axle).laws.append(Law(laws.LIFTOFF, (static[f"tyre:{axle}"], p["share"])))


def _damping(setup: Setup, place: str, p: Values) -> None:
    for axle in setup.axles(place):
        a = setup.layout.axles[axle]
        setup.tyre(axle).c += p["ratio"] * 2.0 * (a.kt * a.mass) ** 0.5


def _footprint(setup: Setup, place: str, p: Values) -> None:
    setup.footprint = p["length"]


def _hinge_friction(setup: Setup, place: str, p: Values) -> None:
    setup.hinge(place).dry += p["moment"]


def _hinge_stiffness(setup: Setup, place: str, p: Values) -> None:
    setup.hinge(place).k += p["k"]


def _runout(setup: Setup, place: str, p: Values) -> None:
    setup.settle = max(setup.settle, 3.0)
    phases = setup.rng.uniform(0.0, 2.0 * np.pi, 2)

    def height(s: Array) -> Array:
        turn = s / p["radius"]
        return np.asarray(p["amplitude"] * (np.sin(turn + phases[0]) + 0.5 * np.sin(3.0 * turn + phases[1])))

    setup.runouts.append((place, height))


TYRE_AND_HINGE = (
    EffectKind(
        "tyre_liftoff", "the tyre cannot pull: f = share max(-(N0 + kt d + ct v), 0), N0 the static load from gravity on the "
        "linear springs", axles_and_all,
        (Value("share", "-", "1: the tyre leaves the road, 0: it may pull", (1.0, 1.0), (1.0, 1.0), neutral=0.0),), _liftoff,
    ),
    EffectKind(
        "tyre_damping", "f = ct v, ct = ratio 2 sqrt(kt m_axle)", axles_and_all,
        (Value("ratio", "-", "damping ratio of the axle on its tyre", (0.015, 0.03), (0.06, 0.15), neutral=0.0),), _damping,
    ),
    EffectKind(
        "tyre_footprint", "the tyre sees the mean of the road over the contact length, centred under the axle", everywhere,
        (Value("length", "m", "contact length", (0.06, 0.1), (0.18, 0.28), neutral=0.0),), _footprint,
    ),
    EffectKind(
        "wheel_runout", "an untrue wheel adds amplitude (sin(s/radius + phase) + sin(3 s/radius + phase)/2) to its road, s the "
        "distance travelled", suspensions,
        (
            Value("amplitude", "m", "of the first harmonic", (0.0004, 0.001), (0.0025, 0.006), neutral=0.0),
            Value("radius", "m", "rolling radius", (0.48, 0.52), (0.48, 0.52), "wheel"),
        ), _runout,
    ),
    EffectKind(
        "hinge_friction", "moment M = moment sign(turning rate) while slipping; any abs(M) <= moment that holds it while sticking", pins,
        (Value("moment", "N m", "moment at which it slips", (0.05, 0.15), (0.3, 1.0), "hinge moment", 0.0),), _hinge_friction,
    ),
    EffectKind(
        "hinge_stiffness", "M = k (theta_front - theta_rear)", pins,
        (Value("k", "N m/rad", "pitch stiffness between the bodies", (0.02, 0.05), (0.15, 0.5), "hinge stiffness", 0.0),), _hinge_stiffness,
    ),
)  # fmt: skip
