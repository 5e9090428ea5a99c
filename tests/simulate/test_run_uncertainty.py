"""What a run file says of how well it knows itself: deviations in SI units or as shares, and each fault at its place."""

from pathlib import Path

import pytest

from tests.simulate.run_files import GOOD, SHORT, load
from vehgen.errors import InputError
from vehgen.files.quantities import Spread

FULL = """uncertainty:
  delay: 50 ms
  speed: 0.36 km/h
  wander: 0.005
  height: 2 mm
  length: 0.02
  form: 0.1
  skew: 0
  clock: 12 ms
  gain: 0.03
  tilt: 2 deg
  position: 5 cm
"""
"""A run file's own words on all that may be off."""


def test_deviations_are_shares_or_si_units(tmp_path: Path):
    found = load(tmp_path, SHORT + FULL).file.uncertainty
    assert found is not None
    assert (found.delay, found.clock, found.position) == (0.05, 0.012, 0.05)
    assert found.speed is not None
    assert (found.speed.value, found.speed.is_share) == (pytest.approx(0.1), False)
    assert found.wander == Spread(0.005, True)
    assert found.height == Spread(0.002, False)
    assert (found.length, found.form, found.skew) == (Spread(0.02, True), Spread(0.1, True), Spread(0.0, True))
    assert found.gain is not None
    assert found.gain.value == pytest.approx(0.03)
    assert found.tilt == pytest.approx(0.0349066, rel=1e-5)


def test_what_is_not_stated_stays_open(tmp_path: Path):
    assert load(tmp_path, GOOD).file.uncertainty is None
    found = load(tmp_path, SHORT + "uncertainty: {speed: 0.01}\n").file.uncertainty
    assert found is not None
    assert found.model_dump(exclude_none=True).keys() == {"speed"}


def test_a_deviation_in_metres_is_a_share_of_what_it_is_of():
    assert Spread(0.002, False).share_of(0.05) == pytest.approx(0.04)
    assert Spread(0.04, True).share_of(0.05) == 0.04


@pytest.mark.parametrize(
    ("entry", "message"),
    [
        ("{@sped: 0.01}", "unknown key 'sped'; did you mean 'speed'?"),
        ("{speed: @0.1 s}", "expected m/s, found s"),
        ("{speed: @1.5}", "expected a share, or a standard deviation with its unit, from 0 up to 1, found 1.5"),
        ("{speed: @-1 km/h}", "expected a standard deviation from 0"),
        ("{speed: @-0.01}", "a share, or a standard deviation with its unit, from 0 up to 1, found -0.01"),
        ("{speed: @1e999 m/s}", "too large a number"),
        ("{speed: @fast}", "expected a plain quantity in m/s, found a symbol in 'fast'"),
        ("{wander: @1 m}", "expected m/s, found m"),
        ("{height: @2 kg}", "expected m, found kg"),
        ("{height: @-2 mm}", "expected a standard deviation from 0"),
        ("{length: @5}", "a share, or a standard deviation with its unit, from 0 up to 1, found 5"),
        ("{form: @1.2}", "expected a share from 0 up to 1, found 1.2"),
        ("{skew: @3 mm}", "expected no unit, found m in '3 mm'"),
        ("{gain: @-0.1}", "expected a share from 0 up to 1, found -0.1"),
        ("{gain: @0.1 m/s^2}", "expected no unit, found m/s^2"),
        ("{delay: @0.2}", "expected s, found no unit in 0.2"),
        ("{delay: @11 s}", "expected a standard deviation from 0 up to 10, found 11"),
        ("{clock: @5 mm}", "expected s, found m"),
        ("{clock: @-5 ms}", "expected a standard deviation from 0 up to 10, found -0.005"),
        ("{tilt: @60 deg}", "expected a standard deviation from 0 up to 1, found 1.0472"),
        ("{position: @0.02}", "expected m, found no unit in 0.02"),
        ("{position: @2 m}", "expected a standard deviation from 0 up to 1, found 2"),
        ("{position: @[1 cm]}", "expected"),
        ("@0.1", "expected `key: value` entries"),
        ("@[speed]", "expected `key: value` entries"),
    ],
)
def test_a_deviation_that_cannot_be_is_refused_at_its_place(tmp_path: Path, entry: str, message: str):
    text = SHORT + f"uncertainty: {entry}\n"
    column = text.splitlines()[2].index("@") + 1
    with pytest.raises(InputError) as caught:
        load(tmp_path, text.replace("@", ""))
    assert str(caught.value.position) == f"{tmp_path / 'run.yaml'}:3:{column}"
    assert message in caught.value.message
    assert "\n" not in str(caught.value)
