"""Values and names given in Python that cannot be are refused as those of files are: in one line that says what was expected."""

import pytest

import vehgen
from vehgen.errors import InputError


@pytest.mark.parametrize("asked", [vehgen.natural_modes, vehgen.static_loads])
@pytest.mark.parametrize(
    ("value", "message"),
    [
        ("300 kN/m", "kS takes a number in SI units here, found '300 kN/m'"),
        (None, "kS takes a number in SI units here, found None"),
        (float("nan"), "`values`: kS must be a finite number, found nan"),
        (float("inf"), "`values`: kS must be a finite number, found inf"),
    ],
)
def test_a_value_that_is_no_number_in_si_is_refused(asked, value, message):
    with pytest.raises(InputError, match=message):
        asked("quarter_car", {"kS": value})


@pytest.mark.parametrize("asked", [vehgen.natural_modes, vehgen.static_loads, vehgen.state_space])
@pytest.mark.parametrize(
    ("name", "message"),
    [("kS", "negative k: axles.axle1.suspension.k is -1"), ("cS", "negative c"), ("mG", "negative mass: axles.axle1.mass")],
)
def test_a_value_that_cannot_be_of_a_spring_a_damper_or_a_mass_is_refused(asked, name, message):
    with pytest.raises(InputError, match=message):
        asked("quarter_car", values={name: -1.0})


def test_a_channel_that_there_is_not_is_told_with_the_nearest(tmp_path):
    (tmp_path / "run.yaml").write_text(
        "vehicle: quarter_car\nspeed: 2 m/s\nroad: [{hump: {shape: versine, length: 0.5 m, height: 2 cm, at: 1 m}}]\n"
        "outputs: {travel: {axle: axle1, quantity: suspension_travel}}\n",
        encoding="utf-8",
    )
    response = vehgen.simulate(tmp_path / "run.yaml")
    name = response.channels[0].name
    assert response.channel(name).shape == (1, len(response.time))
    with pytest.raises(InputError, match=f"did you mean '{name}'"):
        response.channel(f"{name}s")


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: vehgen.load_vehicle(3), "`name`: a file or the name of a bundled model was expected, found int"),
        (lambda: vehgen.road_response("quarter_car", speed="20"), "`speed`: a number in m/s was expected, found '20'"),
        (lambda: vehgen.derive("quarter_car", ["x"]), "`outputs`: a list of PointOutput or ElementOutput was expected, found str"),
        (lambda: vehgen.state_space("quarter_car", forces=["x"]), "`forces`: a list of Place was expected, found str"),
    ],
    ids=range(4),
)
def test_an_argument_of_another_kind_is_refused(call, message):
    with pytest.raises(InputError, match=message):
        call()
