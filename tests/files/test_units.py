"""Units: every factor and dimension against a table typed here, and random products of them."""

from __future__ import annotations

import math
from fractions import Fraction

import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from pydantic import TypeAdapter, ValidationError

from vehgen.errors import InputError, Position
from vehgen.files.checks import unit_factor
from vehgen.files.expressions import ExpressionError, parse
from vehgen.files.quantities import Frequency, PitchRate, read_quantity
from vehgen.files.units import ACCELERATION, MASS, NAMED_DIMENSIONS, UNITS, Dimension, factor_to_si, parse_unit, read_unit

# unit -> (factor to SI, exponents of metre, kilogram, second)
TABLE = {
    "m": (1.0, (1, 0, 0)),
    "mm": (0.001, (1, 0, 0)),
    "cm": (0.01, (1, 0, 0)),
    "km": (1000.0, (1, 0, 0)),
    "in": (0.0254, (1, 0, 0)),
    "ft": (0.3048, (1, 0, 0)),
    "kg": (1.0, (0, 1, 0)),
    "g": (0.001, (0, 1, 0)),
    "t": (1000.0, (0, 1, 0)),
    "lb": (0.45359237, (0, 1, 0)),
    "s": (1.0, (0, 0, 1)),
    "ms": (0.001, (0, 0, 1)),
    "min": (60.0, (0, 0, 1)),
    "h": (3600.0, (0, 0, 1)),
    "Hz": (1.0, (0, 0, -1)),
    "rpm": (1 / 60, (0, 0, -1)),
    "mph": (0.44704, (1, 0, -1)),
    "N": (1.0, (1, 1, -2)),
    "kN": (1000.0, (1, 1, -2)),
    "MN": (1000000.0, (1, 1, -2)),
    "GN": (1000000000.0, (1, 1, -2)),
    "lbf": (4.4482216152605, (1, 1, -2)),
    "Pa": (1.0, (-1, 1, -2)),
    "kPa": (1000.0, (-1, 1, -2)),
    "MPa": (1000000.0, (-1, 1, -2)),
    "GPa": (1000000000.0, (-1, 1, -2)),
    "rad": (1.0, (0, 0, 0)),
    "mrad": (0.001, (0, 0, 0)),
    "deg": (0.017453292519943295, (0, 0, 0)),
}


def dimension(length: int, mass: int, time: int) -> Dimension:
    return Dimension(Fraction(length), Fraction(mass), Fraction(time))


@pytest.mark.parametrize("unit", sorted(TABLE))
def test_each_unit(unit: str):
    factor, exponents = TABLE[unit]
    assert parse_unit(unit) == (factor, dimension(*exponents))
    assert parse(f"2 {unit}").evaluate({}) == 2 * factor
    assert parse(f"2{unit}").dimension({}) == dimension(*exponents)


def test_no_unit_lacks_an_entry_in_the_table():
    assert set(UNITS) == set(TABLE)


factors = st.tuples(st.sampled_from(sorted(TABLE)), st.integers(-9, 9))
joins = st.sampled_from([" ", "  ", "*", " * ", "·", "/", " / "])
powers = st.sampled_from(["^", "**"])


@settings(max_examples=150, deadline=None, derandomize=True)
@example([("kN", 1), ("s", 1), ("m", 1)], [" ", "/"], "^")
@given(st.lists(factors, min_size=1, max_size=5), st.lists(joins, min_size=4, max_size=4), powers)
def test_products_of_units(parts: list[tuple[str, int]], separators: list[str], power: str):
    text, logarithm, exponents = "", 0.0, [0, 0, 0]
    for (unit, exponent), separator in zip(parts, ["", *separators], strict=False):
        text += separator + unit + ("" if exponent == 1 else f"{power}{exponent}")
        exponent *= -1 if "/" in separator else 1
        logarithm += exponent * math.log(TABLE[unit][0])
        exponents = [old + exponent * new for old, new in zip(exponents, TABLE[unit][1], strict=True)]
    factor, found = parse_unit(text)
    assert found == dimension(*exponents)
    assert math.log(factor) == pytest.approx(logarithm, abs=1e-9)
    quantity = parse(f"3.5 {text}")
    assert quantity.evaluate({}) == 3.5 * factor
    assert quantity.dimension({}) == found


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("kgs", r"unknown unit 'kgs'; did you mean 'kg'\?"),
        ("kn/m", r"unknown unit 'kn/m'; did you mean 'kN'\?"),
        ("kNm", r"unknown unit 'kNm'; did you mean 'kN m'\?$"),
        ("kNms/rad", r"did you mean 'kN m s/rad'\?$"),
        ("kgm2", r"did you mean 'kg m\^2'\?$"),
        ("kg m2", r"did you mean 'kg m\^2'\?$"),
        ("kNs/m", r"did you mean 'kN s/m'\?$"),
        ("m/s2", r"did you mean 'm/s\^2'\?$"),
        ("N/mm2", r"did you mean 'N/mm\^2'\?$"),
        ("kmh", "did you mean 'km/h'"),
        ("mN/m", r"did you mean 'MN'\?$"),
        ("kNm" * 10_000, r"did you mean 'kN m kN m .*\.\.\.'\?$"),
        ("mPa", r"unknown unit 'mPa'; did you mean 'MPa'\?"),
        ("metre", "unknown unit 'metre'; known: GN, GPa, Hz, "),
        ("m//s", "unknown unit 'm//s'"),
        ("m s1", "unknown unit 'm s1'"),
        ("", "unknown unit ''"),
        ("2 m", "unknown unit '2 m'"),
        ("m^2.5", "unknown unit"),
        ("m^10", "the exponent of a unit must be between -9 and 9, found 10"),
        ("km^-400", "the exponent of a unit must be between -9 and 9, found -400"),
        ("kg^" + "9" * 5000, "the exponent of a unit"),
    ],
)
def test_what_is_no_unit(text: str, message: str):
    with pytest.raises(InputError, match=message) as caught:
        parse_unit(text)
    assert len(str(caught.value)) < 5500


def test_an_exponent_out_of_reason_is_an_error_of_the_expression_at_its_place():
    with pytest.raises(ExpressionError, match="the exponent of a unit") as caught:
        parse("b1 + 3 km^400")
    assert caught.value.offset == 7


def test_small_raised_digits_are_exponents():
    assert parse_unit("t·m²") == parse_unit("t m^2")
    assert parse_unit("m/s²") == (1.0, ACCELERATION)
    assert parse("2 cm³ / 1 m²").evaluate({}) == pytest.approx(2e-6)


def test_a_quantity_without_a_unit_is_told_one_that_can_be_written():
    with pytest.raises(ValidationError, match=r"write e\.g\. '2 Hz' \('2 rad/s' of an angular rate\)"):
        TypeAdapter(Frequency).validate_python(2)


def test_reading_stops_where_a_parameter_begins():
    assert read_unit("m/s1") == (1.0, dimension(1, 0, 0), 1)
    assert read_unit("N m_1") == (1.0, dimension(1, 1, -2), 1)
    assert read_unit("k1") is None
    assert read_unit("3 m", 2) == (1.0, dimension(1, 0, 0), 3)


def test_a_function_after_a_unit_is_no_unit():
    """`min` is the minute, and a function."""
    expression = parse("2 m * min(b1, 3)")
    assert expression.evaluate({"b1": 5.0}) == 6.0
    assert expression.dimension({"b1": dimension(0, 0, 0)}) == dimension(1, 0, 0)
    assert parse("2 min").evaluate({}) == 120.0


@pytest.mark.parametrize(
    ("exponents", "name"),
    [
        ((0, 0, 0), "no unit"),
        ((1, 0, 0), "m"),
        ((0, 1, -2), "N/m"),
        ((0, 1, -1), "N s/m"),
        ((2, 1, 0), "kg m^2"),
        ((2, 1, -2), "N m"),
        ((2, 1, -1), "N m s"),
        ((1, 1, 0), "kg m"),
        ((-3, 1, 0), "kg m^-3"),
    ],
)
def test_dimensions_are_named_as_the_field_names_them(exponents: tuple[int, int, int], name: str):
    assert str(dimension(*exponents)) == name


def test_every_name_of_a_dimension_can_be_written_as_a_unit():
    for name, found in NAMED_DIMENSIONS.items():
        if name not in ("no unit", "1/s"):
            assert parse_unit(name) == (1.0, found)


def test_g_is_an_acceleration_where_one_is_asked_for_and_a_gram_elsewhere():
    assert factor_to_si("g", ACCELERATION) == 9.80665
    assert factor_to_si("mg", ACCELERATION) == pytest.approx(9.80665e-3, rel=1e-15)
    assert factor_to_si("g", MASS) == 1e-3
    assert factor_to_si("mg", MASS) is None
    assert read_quantity("16 g", ACCELERATION) == pytest.approx(156.9064, rel=1e-12)
    assert read_quantity("16 g", MASS) == 0.016


@pytest.mark.parametrize(
    ("unit", "message"),
    [
        ("banana", "unknown unit 'banana'; known: "),
        ("rads", "unknown unit 'rads'; did you mean 'rad'"),
        ("m/s", "pitch_rate is measured in rad/s, found 'm/s', a unit of m/s"),
        ("rpm", "pitch_rate is measured in rad/s, found 'rpm', turns, not radians"),
        ("Hz", "turns, not radians"),
        ("m^99", "the exponent of a unit"),
    ],
)
def test_a_column_of_another_unit_is_refused_at_its_place(unit: str, message: str):
    place = Position("run.yaml", 3, 4)
    with pytest.raises(InputError, match=r"run\.yaml:3:4: ") as caught:
        unit_factor(unit, "rad/s", "pitch_rate", place)
    assert message in str(caught.value)
    assert unit_factor("deg/s", "rad/s", "pitch_rate", place) == pytest.approx(0.017453292519943295)


def test_a_frequency_may_be_in_rpm_but_no_pitch_rate():
    assert TypeAdapter(Frequency).validate_python("600 rpm") == pytest.approx(10.0)
    assert TypeAdapter(PitchRate).validate_python("180 deg/s") == pytest.approx(math.pi)
    with pytest.raises(ValidationError, match="expected rad/s or deg/s, found turns in '2 rpm'"):
        TypeAdapter(PitchRate).validate_python("2 rpm")


def test_dimensions_multiply_divide_and_take_roots():
    area = dimension(1, 0, 0) * dimension(1, 0, 0)
    assert area == dimension(2, 0, 0)
    assert area / dimension(0, 0, 2) == dimension(2, 0, -2)
    assert area.power(Fraction(1, 2)) == dimension(1, 0, 0)
    assert str(dimension(1, 0, 0).power(Fraction(1, 2))) == "m^1/2"
