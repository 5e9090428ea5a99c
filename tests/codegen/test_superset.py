"""Many candidate laws in one kernel: switched off they add nothing, switched on one by one each is its own kernel."""

import numpy as np
import pytest

from vehgen.codegen import Excitation, Kernel
from vehgen.errors import InputError
from vehgen.mechanics import Place, PointOutput, derive
from vehgen.mechanics.laws import LAWS
from vehgen.mechanics.superset import add_laws
from vehgen.vehicle import load_vehicle

OUTPUTS = (PointOutput("a", Place("L1", "body"), "acceleration"), PointOutput("z", Place("L1", "body"), "displacement"))
STRENGTHS = {
    "dry_friction": 500,
    "asymmetric_friction": 500,
    "elasto_plastic": 500,
    "cubic_stiffness": 2e8,
    "quadratic_stiffness": 2e5,
    "progressive_stiffness": 1e5,
    "bump_stop": 1e6,
    "asymmetric_damping": 4e3,
    "quadratic_damping": 9e3,
    "damper_free_play": 4e3,
    "relaxation": 1e5,
    "hysteresis": 500,
    "tyre_liftoff": 1,
}
CANDIDATES = [("front", "tyre" if name == "tyre_liftoff" else "suspension", name) for name in LAWS]


def hump(model, height=0.1):
    time = np.arange(1501) * 1e-3
    s = time[:, None] * 3.0 - model.wheel_offsets() - 0.3
    inside = (s > 0) & (s < 0.5)
    w = np.where(inside, height * np.sin(np.pi * s / 0.5), 0.0)
    dw = np.where(inside, 3 * height * np.pi / 0.5 * np.cos(np.pi * s / 0.5), 0.0)
    return Excitation(1e-3, w, dw, np.zeros((len(time), 0)))


def run(vehicle, individuals=({},), sweeps=None):
    model = derive(vehicle, OUTPUTS)
    parameters = np.array([list(model.values(overrides=item).values()) for item in individuals])
    return Kernel(model, sweeps=sweeps).run(parameters, hump(model), 5).responses


@pytest.fixture(scope="module")
def superset():
    built = add_laws(load_vehicle("sedan2"), CANDIDATES)
    individuals = [{}, *({built.strength(item): STRENGTHS[item[2]]} for item in CANDIDATES)]
    return built, run(built.vehicle, individuals)


def difference(found, expected):
    return (np.abs(found - expected).max(axis=0) / np.abs(expected).max(axis=0)).max()


def test_switched_off_it_is_the_linear_vehicle(superset):
    assert difference(superset[1][0], run(load_vehicle("sedan2"))[0]) < 1e-10


@pytest.mark.parametrize("candidate", CANDIDATES, ids=lambda item: item[2])
def test_one_law_switched_on_is_its_own_kernel(superset, candidate):
    _, responses = superset
    alone = add_laws(load_vehicle("sedan2"), [candidate])
    expected = run(alone.vehicle, [{alone.strength(candidate): STRENGTHS[candidate[2]]}], sweeps=3)[0]
    assert difference(responses[1 + CANDIDATES.index(candidate)], expected) < 1e-9
    assert difference(expected, responses[0]) > 1e-3


def test_fewer_sweeps_of_a_law_alone_hardly_differ(superset):
    """Alone, a damper takes two sweeps a step; beside dry friction three."""
    candidate = ("front", "suspension", "asymmetric_damping")
    alone = add_laws(load_vehicle("sedan2"), [candidate])
    expected = run(alone.vehicle, [{alone.strength(candidate): STRENGTHS[candidate[2]]}])[0]
    assert 1e-9 < difference(superset[1][1 + CANDIDATES.index(candidate)], expected) < 1e-5


def test_every_place_and_parameter_is_offered():
    candidates = [
        ("fifth_wheel", "hinge", "dry_friction"),
        ("axle4", "tyre", "quadratic_damping"),
        ("mount", "link", "bump_stop"),
        ("axle4", "suspension", "bump_stop"),
    ]
    built = add_laws(load_vehicle("tractor5_module"), candidates)
    assert list(built.names) == candidates
    parameters = built.vehicle.parameters
    assert built.strength(candidates[0]) == "fifth_wheel_hinge_dry_friction_force"
    assert str(built.vehicle.dimensions[built.strength(candidates[0])]) == "N m"
    assert built.vehicle.values()["mount_link_bump_stop_rebound"] == 1000
    assert parameters["mount_link_bump_stop_rebound"].range is None
    assert built.vehicle.ranges()["axle4_suspension_bump_stop_clearance"] == (0.005, 0.1)
    again = add_laws(built.vehicle, candidates[:1])
    assert again.strength(candidates[0]) == "fifth_wheel_hinge_dry_friction_force_2"
    assert len(derive(again.vehicle).elements) == len(derive(built.vehicle).elements)


@pytest.mark.parametrize(
    ("candidates", "message"),
    [
        ([("frnt", "suspension", "bump_stop")], "no suspension 'frnt'; did you mean 'front'"),
        ([("front", "suspension", "bumpstop")], "did you mean 'bump_stop'"),
        ([("front", "suspension", "tyre_liftoff")], "belongs on a tyre, not on a suspension"),
        ([("front", "tyre", "bump_stop")] * 2, "given twice"),
    ],
)
def test_what_cannot_be_added_is_refused(candidates, message):
    with pytest.raises(InputError, match=message):
        add_laws(load_vehicle("sedan2"), candidates)
