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
