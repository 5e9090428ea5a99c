"""The struct for VBI-2D against its own published vehicle: matrices assembled from its parameters in its convention, and its numbers."""

import numpy as np
import pytest
import scipy.io
import scipy.linalg

from tests.bundled import few
from tests.export.vehicles import sedan_with, truck
from vehgen.errors import InputError
from vehgen.export import export
from vehgen.simulate import natural_modes
from vehgen.vehicle import bundled_models, load_vehicle

# option "Vehicle 2A3" of VBI-2D: two bodies, articulated; x to the rear, y(x) = yB + x*theta, a: front hinge to COG, b: COG to rear hinge
BODY_MASS, BODY_INERTIA, A2, B1 = [4500.0, 31450.0], [4604.0, 16302.0], 6.15, 2.15
K_SUSPENSION, C_SUSPENSION = [4.0e5, 1.0e6, 7.5e5, 7.5e5, 7.5e5], [1e3] * 5
GROUP_MASS, K_TYRE, C_TYRE = [700.0, 1100.0, 750.0, 750.0, 750.0], [1.75e6, 3.5e6, 3.5e6, 3.5e6, 3.5e6], [1e4] * 5
GROUP_PLACE, GROUP_BODY = [-0.5, 2.5, 1.8, 2.9, 4.0], [0, 0, 1, 1, 1]
FREQUENCIES = [1.4105487359, 1.5890769411, 5.2350767470, 8.8508275359, 10.5353064694, 11.9807488703, 11.9817410523, 12.1270944255]
POLES = [-0.09186568130782 + 8.8636561404438j, -4.93423573918695 + 65.9974699352859j, -7.28557634206917 + 75.8245570964077j]
LOADS = [55162.20664017522, 105278.27884704091, 78252.47741669805, 77319.83817092795, 76387.19892515783]


def published():
    """Assemble M, C, K of yB1, thetaB1, thetaB2, yG1..5 from the parameters: yB2 = yB1 + b1 thetaB1 + a2 thetaB2."""
    heave = np.array([[1.0, 0, 0, *[0] * 5], [1.0, B1, A2, *[0] * 5]])
    pitch = np.eye(8)[1:3]
    wheel = np.eye(8)[3:]
    M = sum(m * np.outer(row, row) for m, row in zip([*BODY_MASS, *BODY_INERTIA, *GROUP_MASS], [*heave, *pitch, *wheel], strict=True))
    springs = [heave[b] + d * pitch[b] - wheel[j] for j, (b, d) in enumerate(zip(GROUP_BODY, GROUP_PLACE, strict=True))]
    C, K = (
        sum(k * np.outer(row, row) for k, row in zip([*upper, *lower], [*springs, *wheel], strict=True))
        for upper, lower in ((C_SUSPENSION, C_TYRE), (K_SUSPENSION, K_TYRE))
    )
    return M, C, K


@pytest.fixture(scope="module")
def struct(tmp_path_factory):
    (path,) = export("vbi2d_2A3", "vbi2d", tmp_path_factory.mktemp("vbi") / "truck.mat")
    return scipy.io.loadmat(path, simplify_cells=True)["Veh"]


def test_the_matrices_are_the_published_vehicles(struct):
    for name, expected in zip("MCK", published(), strict=True):
        assert struct["SysM"][name] == pytest.approx(expected, rel=1e-13, abs=1e-9)
    squares = scipy.linalg.eigh(struct["SysM"]["K"], struct["SysM"]["M"], eigvals_only=True)
    assert np.sqrt(squares) / (2 * np.pi) == pytest.approx(FREQUENCIES, rel=1e-9)


def test_the_poles_are_the_published_ones(struct):
    M, C, K = (struct["SysM"][name] for name in "MCK")
    A = np.block([[np.zeros((8, 8)), np.eye(8)], [-np.linalg.solve(M, K), -np.linalg.solve(M, C)]])
    found = np.linalg.eigvals(A)
    for pole in POLES:
        assert np.abs(found - pole).min() < 1e-8


def test_wheels_names_and_static_loads(struct):
    assert (struct["SysM"]["N2w"] == np.eye(8)[3:]).all()
    assert [item["name"] for item in struct["DOF"]] == ["yB1", "thetaB1", "thetaB2", "yG1", "yG2", "yG3", "yG4", "yG5"]
    assert {item["type"] for item in struct["DOF"] if "theta" in item["name"]} == {"Rotational"}
    assert struct["Static"]["load"] == pytest.approx(LOADS, rel=1e-12)
    assert struct["Static"]["check"] == pytest.approx(0.0, abs=1e-6)
    assert struct["Prop"]["kTk"].tolist() == K_TYRE
    assert struct["Prop"]["cTk"].tolist() == C_TYRE
    assert struct["Prop"]["ax_dist"] == pytest.approx([0.0, 3.0, 10.6, 11.7, 12.8])


@pytest.mark.parametrize("name", few(name for name in bundled_models() if load_vehicle(name).axles and name != "drop_test"))
def test_every_bundled_vehicle_stands_and_swings_as_it_does_here(name, tmp_path):
    (path,) = export(name, "vbi2d", tmp_path / "a.mat")
    found = scipy.io.loadmat(path, simplify_cells=True)["Veh"]
    squares = scipy.linalg.eigh(found["SysM"]["K"], found["SysM"]["M"], eigvals_only=True)
    assert np.sqrt(squares) / (2 * np.pi) == pytest.approx([mode.undamped_hz for mode in natural_modes(name)], rel=1e-9)
    assert np.atleast_2d(found["SysM"]["N2w"]).shape == (np.size(found["Static"]["load"]), len(found["SysM"]["M"]))


def test_what_it_cannot_carry_is_refused_by_name(tmp_path):
    with pytest.raises(InputError, match=r"dry_friction of suspension front .* cannot be carried by vbi2d"):
        export(sedan_with("dry_friction"), "vbi2d", tmp_path / "a.mat")
    with pytest.raises(InputError, match="truck: the link rope to the ground cannot be carried by vbi2d"):
        export(truck(), "vbi2d", tmp_path / "a.mat")
    assert list(tmp_path.iterdir()) == []
