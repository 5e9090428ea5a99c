"""Values: their signs, sizes, ranges and sets, and parameters that follow one another."""

from __future__ import annotations

import pytest

from tests.vehicle.rig import GOOD, Fault, check_refused, name_of
from vehgen.errors import InputError
from vehgen.vehicle import parse_vehicle
from vehgen.vehicle.checks import check_values

FAULTS: list[Fault] = [
    # values
    ("negative mass", "mass: 5 t", "mass: @-5 t", "negative mass: bodies.trailer.mass is -5000; it must not be below 0"),
    (
        "negative inertia",
        "5 t, pitch_inertia: 9000",
        "5 t, pitch_inertia: @-9000",
        "negative pitch_inertia: bodies.trailer.pitch_inertia is -9000",
    ),
    ("negative by a symbol", "8000 kg, m", "-8000 kg, m", "8:17: negative mass: bodies.frame.mass is -8000"),
    ("negative stiffness", "k: 100 kN/m", "k: @-100 kN/m", "negative k: links.mount.k is -100000"),
    ("negative damping", "c: 1 kN s/m", "c: @-1 kN s/m", "negative c: links.mount.c is -1000"),
    ("no mass to hop", "mass: 600 kg", "mass: @0 kg", "a degree of freedom without inertia: axle 'front' hops with no mass"),
    ("no mass to heave", "mass: 800 kg", "mass: @0 kg", "a degree of freedom without inertia: body 'cab' heaves with no mass"),
    (
        "no inertia given",
        "cab: {mass: 800 kg, size: {length: 2 m, height: 1 m}, ",
        "@cab: {mass: 800 kg, ",
        "a degree of freedom without inertia: body 'cab' pitches; give `pitch_inertia` or `size`, or `motions: [heave]`",
    ),
    (
        "no size",
        "{length: 2 m, height: 1 m}",
        "@{length: 0 m, height: 0 m}",
        "a degree of freedom without inertia: body 'cab' pitches with no pitch inertia",
    ),
    (
        "no inertia",
        "size: {length: 2 m, height: 1 m}",
        "pitch_inertia: @0",
        "a degree of freedom without inertia: body 'cab' pitches with no pitch inertia",
    ),
    ("range above", "[0.8 m, 2.2 m]", "@[1.8 m, 2.2 m]", "the value of b1, 1.32, lies outside its range [1.8, 2.2] (SI units)"),
    ("range below", "[0.8 m, 2.2 m]", "@[80 cm, 1310 mm]", "the value of b1, 1.32, lies outside its range [0.8, 1.31] (SI units)"),
    ("range upside down", "[0.8 m, 2.2 m]", "@[2.2 m, 0.8 m]", "the range of b1 is empty: 2.2 is not below 0.8"),
    ("range of a point", "[0.8 m, 2.2 m]", "@[1.32 m, 1.32 m]", "the range of b1 is empty"),
    ("range of one", "[0.8 m, 2.2 m]", "@[0.8 m]", "a range has two ends: [low, high]"),
    ("range of three", "[0.8 m, 2.2 m]", "@[0.8 m, 1 m, 2.2 m]", "a range has two ends: [low, high]"),
    ("range of none", "[0.8 m, 2.2 m]", "@2 m", "a range has two ends: [low, high]"),
    (
        "range of what follows",
        "3.46 m - b1,",
        "3.46 m - b1, range: [1 m, 3 m],",
        "5:7: a parameter with `equals` follows others; its `range` belongs to them",
    ),
    ("value and equals", "3.46 m - b1,", "3.46 m - b1, value: 2 m,", "5:7: a parameter has either `value` or `equals`"),
    ("neither value nor equals", "value: 200 kN/m, ", "", "6:7: a parameter has either `value` or `equals`"),
    ("division by zero in a value", "8000 kg, m", "@8000 kg/0, m", "'8000 kg/0' has no value: float division by zero"),
    ("division by zero in a range", "[0.8 m, 2.2 m]", "[0.8 m, @2.2 m/0]", "'2.2 m/0' has no value"),
    ("division by zero in a set", "kF: 150 kN/m", "kF: @150 kN/m/0", "'150 kN/m/0' has no value"),
    ("division by zero in equals", "3.46 m - b1,", "@3.46 m/(1.32 m - b1) * 1 m,", "'3.46 m/(1.32 m - b1) * 1 m' has no value"),
    ("division by zero in a body", "mass: mB", "mass: @mB/(mB/mB - 1)", "'mB/(mB/mB - 1)' has no value"),
    ("division of the wrong unit by zero", "mass: mB", "mass: @1/0", "missing unit: bodies.frame.mass must be in kg"),
    ("root of a negative", "mass: mB", "mass: @mB*sqrt(-1)", "'mB*sqrt(-1)' has no value"),
    ("too large to write", "8000 kg, m", "@1e999 kg, m", "1e999 is too large a number"),
    ("too large by a product", "8000 kg, m", "@1e200 * 1e200 kg, m", "'1e200 * 1e200 kg' is not a finite number"),
    (
        "too large for any vehicle",
        "k: 1 MN/m}}\n  last",
        "k: @1e300 N/m}}\n  last",
        "axles.rear.tyre.k is out of any scale: a stiffness is at most 1e+15 N/m in magnitude, found 1e+300 N/m: a question of units?",
    ),
    (
        "too small for any vehicle",
        "mass: 5 t",
        "mass: @1e-300 kg",
        "bodies.trailer.mass is out of any scale: a mass is 1e-06 to 1e+07 kg in magnitude, found 1e-300 kg: a question of units?",
    ),
    ("too long for any vehicle", "x: -b2", "x: @-3000 m", "axles.rear.x is out of any scale: a length on a vehicle is at most 1000 m"),
    ("infinite", "8000 kg, m", "@.inf, m", "`value` is a plain quantity"),
    ("size backwards", "size: {length: 2 m", "size: {length: @-2 m", "bodies.cab.size.length must not be below 0, found -2"),
    (
        "range of a stiffness below 0",
        "kF: {value: 200 kN/m, meaning: front stiffness}",
        "kF: {value: 200 kN/m, range: @[-20 kN/m, 300 kN/m]}",
        "the range of kF reaches what cannot be: negative k: axles.front.suspension.k is -20000 at the end of a range",
    ),
    ("set of what follows", "kF: 150 kN/m", "@b2: 1 m", "a set changes parameters that have a `value`; 'b2' has `equals`, and"),
    ("set with symbols", "kF: 150 kN/m", "kF: @0.5*kF", "a set lists plain quantities, not expressions of parameters"),
    (
        "set of a wrong value",
        "kF: 150 kN/m",
        "kF: -1 N/m",
        "15:61: negative k: axles.front.suspension.k is -1 in the set 'soft'; it must not be below 0",
    ),
    ("set of no entries", "soft: {kF: 150 kN/m}", "soft: @5", "expected `key: value` entries"),
    # circles
    ("equals itself", "3.46 m - b1", "@3.46 m - b2", "circular `equals`: b2 -> b2"),
]


@pytest.mark.parametrize("fault", FAULTS, ids=name_of)
def test_a_fault_of_values(fault: Fault):
    check_refused(*fault[1:])


def test_the_good_file_is_good():
    vehicle = parse_vehicle(GOOD)
    assert vehicle.all_values(vehicle.values("soft")) == {"mB": 8000.0, "b1": 1.32, "b2": 3.46 - 1.32, "kF": 150000.0}


def test_a_circle_of_three_parameters():
    text = GOOD.replace("value: 200 kN/m", "equals: b3 * 1 kN/m^2").replace("bodies:\n", "  b3: {equals: kF * 1 m^2/kN + b1}\nbodies:\n", 1)
    with pytest.raises(InputError, match=r"bad\.yaml:7:16: circular `equals`: kF -> b3 -> kF$"):
        parse_vehicle(text, "bad.yaml")


def test_a_circle_that_is_reached_through_a_value():
    """A parameter that follows one whose `value` names itself."""
    text = GOOD.replace("b2: {equals: 3.46 m - b1", "b2: {equals: b3").replace("bodies:\n", "  b3: {value: b3}\nbodies:\n", 1)
    with pytest.raises(InputError, match=r"bad\.yaml:7:15: `value` is a plain quantity"):
        parse_vehicle(text, "bad.yaml")


def test_parameters_that_follow_one_another_in_a_net_are_checked_once_each():
    """Each follows the two before it: checking every path would take 2^30 steps."""
    lines = "".join(f"  f{i}: {{equals: f{i - 1} + f{i - 2}}}\n" for i in range(2, 45))
    text = GOOD.replace("bodies:\n", "  f0: {value: 1 mm}\n  f1: {value: 1 mm}\n" + lines + "bodies:\n", 1)
    vehicle = parse_vehicle(text)
    assert vehicle.all_values(vehicle.values())["f44"] == pytest.approx(1134903.170)


@pytest.mark.parametrize("order", ["forwards", "backwards", "from the middle"])
def test_a_chain_of_equals_that_would_exhaust_the_stack_is_refused(order: str):
    lines = [f"  f{i}: {{equals: f{i - 1}}}\n" for i in range(1, 900)]
    if order == "backwards":
        lines.reverse()
    elif order == "from the middle":
        lines.insert(0, "  top: {equals: " + " + ".join(f"f{i}" for i in range(40, 900, 40)) + "}\n")
    text = GOOD.replace("bodies:\n", "  f0: {value: 1 m}\n" + "".join(lines) + "bodies:\n", 1)
    with pytest.raises(InputError, match=r"bad\.yaml:\d+:\d+: more than 100 parameters follow one another through `equals`"):
        parse_vehicle(text, "bad.yaml")


def test_a_chain_of_ninety_parameters_is_read():
    lines = "".join(f"  f{i}: {{equals: f{i - 1} + 1 m}}\n" for i in range(1, 90))
    vehicle = parse_vehicle(GOOD.replace("bodies:\n", "  f0: {value: 1 m}\n" + lines + "bodies:\n", 1))
    assert vehicle.all_values(vehicle.values())["f89"] == 90.0


def test_sets_and_overrides_that_are_not_there():
    vehicle = parse_vehicle(GOOD)
    with pytest.raises(InputError, match=r"^rig has no parameter set 'sfot'; did you mean 'soft'\?$"):
        vehicle.values("sfot")
    with pytest.raises(InputError, match=r"^rig: 'b2' has `equals` and follows b1; give a value to these instead$"):
        vehicle.values(overrides={"b2": 1.0})
    with pytest.raises(InputError, match=r"^rig has no parameter 'b3' with a value; known: b1, kF, mB$"):
        vehicle.values(overrides={"b3": 1.0})


def test_values_of_a_population_are_checked_too():
    vehicle = parse_vehicle(GOOD, "good.yaml")
    check_values(vehicle, vehicle.values())
    with pytest.raises(InputError, match=r"^good\.yaml:8:17: negative mass: bodies\.frame\.mass is -1 here; it must not be below 0$"):
        check_values(vehicle, vehicle.values(overrides={"mB": -1.0}), " here")
    with pytest.raises(InputError, match=r"^good\.yaml:8:17: bodies\.frame\.mass is not a finite number$"):
        check_values(vehicle, vehicle.values(overrides={"mB": float("nan")}))
