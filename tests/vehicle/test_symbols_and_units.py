"""Symbols, units and arithmetic: every expression of a vehicle must mean a quantity of its kind."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.vehicle.rig import GOOD, Fault, check_refused, name_of
from vehgen.errors import InputError
from vehgen.vehicle import load_vehicle

FAULTS: list[Fault] = [
    # symbols
    ("symbol of a body", "mass: mB", "mass: @mb1", "unknown symbol 'mb1'; did you mean 'mB' or 'b1'?"),
    ("symbol inside", "x: -b2", "x: -(b2 + 2*@b3)", "unknown symbol 'b3'; known: b1, b2, kF, mB"),
    ("symbol in quotes", "x: -b2", "x: '-(b2 + @b3)'", "unknown symbol 'b3'; known: b1, b2, kF, mB"),
    ("symbol in equals", "3.46 m - b1", "3.46 m - @b", "unknown symbol 'b'; did you mean 'mB' or 'b2' or 'b1'?"),
    (
        "symbol in a value",
        "8000 kg, m",
        "@8000 * kF, m",
        "`value` is a plain quantity; to follow other parameters write `equals: 8000 * kF`",
    ),
    ("symbol of itself", "8000 kg, m", "@mB, m", "`value` is a plain quantity"),
    ("symbol in a range", "[0.8 m, 2.2 m]", "@[b2, 2.2 m]", "`range` is a plain quantity"),
    # units
    (
        "no unit in a value",
        "mass: mB",
        "mass: @8000",
        "missing unit: bodies.frame.mass must be in kg, found no unit in '8000'; write e.g. '8000 kg'",
    ),
    ("no unit in a number beside a share", "3.46 m - b1", "@2 * b1 / b1 * b1 - 3", "cannot subtract m and no unit"),
    ("no unit in a sum", "3.46 m - b1", "@3.46 - b1", "cannot subtract no unit and m"),
    (
        "no unit in a sum's parameter",
        "b1: {value: 1.32 m, range: [0.8 m, 2.2 m]",
        "b1: {value: 1.32",
        "5:16: cannot subtract m and no unit; 'b1' has no unit",
    ),
    (
        "no unit in a stiffness",
        "200 kN/m, m",
        "200, m",
        "15:61: missing unit: axles.front.suspension.k must be in N/m, found no unit in 'kF'; give 'kF' its unit",
    ),
    (
        "no unit in a value that has a range",
        "equals: 3.46 m - b1",
        "value: 2.14, range: [1 m, 3 m]",
        "16:26: missing unit: axles.rear.x must be in m, found no unit in '-b2'; give 'b2' its unit",
    ),
    (
        "no unit in a range",
        "[0.8 m, 2.2 m]",
        "[0.8 m, @2.2]",
        "missing unit: parameters.b1.range.1 must be in m, found no unit in '2.2'; write e.g. '2.2 m'",
    ),
    ("wrong unit in a body", "mass: 5 t", "mass: @5 m", "bodies.trailer.mass must be in kg, found m in '5 m'"),
    ("wrong unit of a symbol", "mass: mB", "mass: @b1", "bodies.frame.mass must be in kg, found m in 'b1'"),
    ("wrong unit of damping", "c: 5 kN s/m", "c: @5 kN/m", "axles.front.suspension.c must be in N s/m, found N/m in '5 kN/m'"),
    (
        "wrong unit of a tyre",
        "rear: {body: frame, x: -b2, tyre: {k: 1 MN/m}}",
        "rear: {body: frame, x: -b2, tyre: {k: @1 MN}}",
        "axles.rear.tyre.k must be in N/m, found N",
    ),
    ("wrong unit of a hinge", "k: 1 kN m/rad", "k: @1 kN/m", "hinges.pin.k must be in N m, found N/m"),
    (
        "wrong unit of inertia",
        "5 t, pitch_inertia: 9000 kg m^2",
        "5 t, pitch_inertia: @9000 kg m",
        "bodies.trailer.pitch_inertia must be in kg m^2, found kg m",
    ),
    ("wrong unit of a place", "body: trailer, x: 0 m", "body: trailer, x: @10 kg", "bodies.load.carried_by.x must be in m, found kg"),
    ("wrong unit of a size", "length: 2 m", "length: @2 s", "bodies.cab.size.length must be in m, found s"),
    ("wrong unit in a set", "kF: 150 kN/m", "kF: @150 kN", "sets.soft.kF must be in N/m, found N in '150 kN'"),
    ("sum of unlike units", "3.46 m - b1", "@3.46 m - mB", "cannot subtract m and kg"),
    ("later sum of unlike units", "x: -b2", "x: -b2 + (@1 kg + b1)", "cannot add kg and m"),
    ("unit unknown", "8000 kg, m", "8000 @kgs, m", "'kgs' after 8000 is not a unit; did you mean 'kg'?"),
    ("unit in small letters", "k: 100 kN/m", "k: 100 @kn/m", "'kn' after 100 is not a unit; did you mean 'kN'?"),
    ("unit without its space", "k: 100 kN/m", "k: 100 @kNm", "'kNm' after 100 is not a unit; did you mean 'kN m'?"),
    ("unit in quotes", "8000 kg, m", '"8000 @kgs", m', "'kgs' after 8000 is not a unit"),
    ("unit's exponent", "8000 kg, m", "8000 @kg^99, m", "the exponent of a unit must be between -9 and 9, found 99"),
    (
        "parameter named as a unit",
        "  mB: {value",
        "  @kg: {value",
        "'kg' is a unit and cannot name a parameter; choose e.g. kg1 or kg_body",
    ),
    ("parameter named as the minute", "  kF: {value", "  @min: {value", "'min' is a unit and cannot name a parameter"),
    # expressions that are more than arithmetic
    ("call", "3.46 m - b1", "@open(b1)", "only sqrt, abs, sign, min, max may be called in an expression"),
    ("call later", "3.46 m - b1", "3.46 m - @exec(b1)", "only sqrt, abs, sign, min, max may be called"),
    (
        "attribute",
        "3.46 m - b1",
        "b1@.real",
        "only numbers, units, parameter names, + - * / ** and sqrt, abs, sign, min, max may stand in an expression, found '.'",
    ),
    ("text", "3.46 m - b1", "\"b1 + @'m'\"", "only numbers, units, parameter names"),
    ("comment", "3.46 m - b1", '"b1 @# b2"', "only numbers, units, parameter names"),
    ("decimal comma", "3.46 m - b1", "'3@,46 m - b1'", "found a comma; decimals are written with a point"),
    ("underscore", "3.46 m - b1", "3.46 m - @__import__", "a name may not start with an underscore: '__import__'"),
    ("power of a symbol", "3.46 m - b1", "@b1**b1", "an exponent must be a plain number between -10 and 10"),
    ("a list for a number", "mass: 5 t", "mass: @[5 t]", "expected a number with its unit or an expression, such as '3.46 m - b1'"),
    ("a truth for a number", "mass: 5 t", "mass: @true", "expected a number with its unit or an expression"),
    ("nothing for a number", "mass: 5 t", "mass: null", "9:19: expected a number with its unit or an expression"),
]


@pytest.mark.parametrize("fault", FAULTS, ids=name_of)
def test_a_fault_of_symbols_or_units(fault: Fault):
    check_refused(*fault[1:])


def test_a_parameter_of_the_wrong_unit_is_told_where_it_is_declared(tmp_path: Path):
    """Of a file that extends another the declaration is blamed: the use was right before."""
    (tmp_path / "base.yaml").write_text(GOOD, encoding="utf-8")
    (tmp_path / "own.yaml").write_text("extends: base.yaml\nname: own\nparameters: {kF: {value: 20 kN}}\n", encoding="utf-8")
    with pytest.raises(InputError) as caught:
        load_vehicle(tmp_path / "own.yaml")
    assert str(caught.value).startswith(f"{tmp_path / 'own.yaml'}:3:26: axles.front.suspension.k must be in N/m, found N in 'kF' at ")
    assert str(caught.value).endswith("base.yaml:15:61")
    alone = GOOD.replace("kF: {value: 200 kN/m", "kF: {value: 200 kN", 1).replace("sets:\n  soft: {kF: 150 kN/m}\n", "")
    (tmp_path / "alone.yaml").write_text(alone, encoding="utf-8")
    with pytest.raises(InputError, match=r"alone\.yaml:15:61: .*found N in 'kF'; line 6 declares it$"):
        load_vehicle(tmp_path / "alone.yaml")
