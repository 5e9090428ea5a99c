"""Faulty vehicles: each change of a good file is refused at the marked column with a text that helps.

`@` marks where the error must point; it is taken out before the file is read.
"""

from __future__ import annotations

import time

import pytest

from vehgen.errors import InputError
from vehgen.vehicle import load_vehicle, parse_vehicle
from vehgen.vehicle.checks import check_values

GOOD = """\
name: rig
parameters:
  mB: {value: 8000 kg, meaning: body mass}
  b1: {value: 1.32 m, range: [0.8 m, 2.2 m], meaning: axle 1 ahead of the COG}
  b2: {equals: 3.46 m - b1, meaning: axle 2 behind the COG}
  kF: {value: 200 kN/m, meaning: front stiffness}
bodies:
  frame: {mass: mB, pitch_inertia: 9000 kg m^2}
  trailer: {mass: 5 t, pitch_inertia: 9000 kg m^2}
  cab: {mass: 800 kg, size: {length: 2 m, height: 1 m}, carried_by: {body: frame, x: 1 m, z: 1 m}}
  load: {mass: 900 kg, motions: [], carried_by: {body: trailer, x: 0 m, z: 1 m}}
hinges:
  pin: {frame: {x: -2 m, z: 0}, trailer: {x: 3 m, z: 0}, k: 1 kN m/rad}
axles:
  front: {body: frame, x: b1, mass: 600 kg, suspension: {k: kF, c: 5 kN s/m}, tyre: {k: 1 MN/m}}
  rear: {body: frame, x: -b2, tyre: {k: 1 MN/m}}
  last: {body: trailer, x: -2 m, tyre: {k: 1 MN/m}}
links:
  mount: {frame: {x: 1 m}, cab: {x: 0 m}, k: 100 kN/m, c: 1 kN s/m}
  shaker: {ground: {}, trailer: {x: 1 m}, k: 10 kN/m}
sets:
  soft: {kF: 150 kN/m}
"""

# (what, old text, new text with the mark @, how the message begins)
CASES = [
    # unknown keys, with the nearest valid one
    ("body key", "{mass: mB,", "{@masss: mB,", "unknown key 'masss'; did you mean 'mass'?"),
    ("axle key", "x: b1, mass", "@y: b1, mass", "unknown key 'y'; known: body, mass, suspension, title, tyre, x"),
    ("spring key", "{k: kF, c", "{@stiffness: kF, c", "unknown key 'stiffness'; known: c, k"),
    ("point key", "frame: {x: -2 m, z: 0}", "frame: {x: -2 m, @y: 0}", "unknown key 'y'; known: x, z"),
    ("link's point key", "cab: {x: 0 m}", "cab: {@xx: 0 m}", "unknown key 'xx'; did you mean 'x'?"),
    ("carrier key", "frame, x: 1 m, z: 1 m", "frame, x: 1 m, @zz: 1 m", "unknown key 'zz'; did you mean 'z'?"),
    ("size key", "height: 1 m", "@hight: 1 m", "unknown key 'hight'; did you mean 'height'?"),
    ("parameter key", "8000 kg, meaning", "8000 kg, @meanning", "unknown key 'meanning'; did you mean 'meaning'?"),
    ("top key", "links:", "@link:", "unknown key 'link'; did you mean 'links'?"),
    ("merge key", "{mass: 5 t,", "{@<<: {}, mass: 5 t,", "unknown key '<<'; known: "),
    # symbols
    ("symbol of a body", "mass: mB", "mass: @mb1", "unknown symbol 'mb1'; did you mean 'b1'?"),
    ("symbol inside", "x: -b2", "x: -(b2 + 2*@b3)", "unknown symbol 'b3'; known: b1, b2, kF, mB"),
    ("symbol in quotes", "x: -b2", "x: '-(b2 + @b3)'", "unknown symbol 'b3'; known: b1, b2, kF, mB"),
    ("symbol in equals", "3.46 m - b1", "3.46 m - @b", "unknown symbol 'b'; did you mean 'b2' or 'b1'?"),
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
    ("no unit in a sum", "3.46 m - b1", "@3.46 - b1", "cannot subtract no unit and m"),
    ("no unit in a stiffness", "200 kN/m, m", "200, m", None),
    ("no unit in a value that has a range", "equals: 3.46 m - b1", "value: 2.14, range: [1 m, 3 m]", None),
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
    ("unit in quotes", "8000 kg, m", '"8000 @kgs", m', "'kgs' after 8000 is not a unit"),
    ("unit's exponent", "8000 kg, m", "8000 @kg^99, m", "the exponent of a unit must be between -9 and 9, found 99"),
    (
        "parameter named as a unit",
        "  mB: {value",
        "  @kg: {value",
        "'kg' is a unit and cannot name a parameter; choose e.g. kg1 or kg_body",
    ),
    ("parameter named as the minute", "  kF: {value", "  @min: {value", "'min' is a unit and cannot name a parameter"),
    # names
    ("duplicate key", "  trailer: {mass", "  @frame: {mass", "duplicate name 'frame'; each may stand once"),
    ("duplicate parameter", "  b2: {equals", "  @b1: {equals", "duplicate name 'b1'"),
    ("duplicate across kinds", "  mount: {", "  @front: {", "duplicate name 'front': it is already in `axles`"),
    (
        "name with a dash",
        "  pin: {frame",
        "  @pin-1: {frame",
        "'pin-1' cannot be a name: a letter, then letters, digits and underscores were expected",
    ),
    ("name with a dot", "  kF: {value", "  @k.F: {value", "'k.F' cannot be a name"),
    ("name of an underscore", "  pin: {frame", "  @_pin: {frame", "'_pin' cannot be a name"),
    ("name that Python keeps", "  kF: {value", "  @lambda: {value", "'lambda' cannot be a name"),
    ("name of other letters", "  mount: {", "  @träger: {", "'träger' cannot be a name"),
    ("name of the ground", "  trailer: {mass", "  @ground: {mass", "'ground' has a meaning of its own and cannot be a name"),
    ("name of a key", "  shaker: {", "  @title: {", "'title' has a meaning of its own"),
    (
        "name that leaves its folder",
        "name: rig",
        "name: @../../rig",
        "'../../rig' cannot be a name: letters, digits and the",
    ),
    ("name from the root", "name: rig", "name: @/tmp/rig", "'/tmp/rig' cannot be a name"),
    ("name of nothing", "name: rig", "name: @''", "'' cannot be a name"),
    ("name with a bell", "name: rig", 'name: @"a\\a"', "the character U+0007 is not allowed in a text"),
    # connections
    ("axle on no body", "front: {body: frame", "front: {body: @frmae", "no body 'frmae'; did you mean 'frame'?"),
    ("axle on the ground", "front: {body: frame", "front: {body: @ground", "no body 'ground'; known: cab, frame, load, trailer"),
    ("axle on nothing", "front: {body: frame,", "@front: {", "axles.front lacks the key 'body'"),
    ("hinge to no body", "trailer: {x: 3 m, z: 0}", "@trialer: {x: 3 m, z: 0}", "no body 'trialer'; did you mean 'trailer'?"),
    ("hinge to the ground", "trailer: {x: 3 m, z: 0}", "@ground: {}", "no body 'ground'"),
    ("hinge of three", "trailer: {x: 3 m, z: 0}", "trailer: {}, cab: {}", None),
    (
        "hinge to a rider",
        "trailer: {x: 3 m, z: 0}",
        "@cab: {}",
        "a hinged body needs heave and pitch of its own and no carrier; 'cab' has not",
    ),
    ("hinge to a heaver", "{mass: 5 t,", "{motions: [heave], mass: 5 t,", None),
    ("link to no body", "cab: {x: 0 m}", "@cap: {x: 0 m}", "no body 'cap'; did you mean 'cab'?"),
    ("link to nothing", "ground: {}, ", "", None),
    ("carried by no body", "carried_by: {body: frame", "carried_by: {body: @fram", "no body 'fram'; did you mean 'frame'?"),
    ("carried by itself", "carried_by: {body: frame", "carried_by: @{body: cab", "bodies carry each other in a circle: cab -> cab"),
    ("no motion, no carrier", "carried_by: {body: trailer, x: 0 m, z: 1 m}", "title: a", None),
    ("a motion twice", "motions: []", "motions: @[heave, heave]", "a motion is listed twice"),
    ("a motion that is none", "motions: []", "motions: [heave, @roll]", "input should be 'heave' or 'pitch', found 'roll'"),
    ("one motion", "motions: []", "motions: @heave", "expected a list: [first, second]"),
    (
        "placed twice",
        "trailer: {mass",
        "trailer: {@at: -5 m, mass",
        "body 'trailer' is placed already, by what connects it to the first body",
    ),
    ("first body placed", "frame: {mass", "frame: {@at: 5 m, mass", "body 'frame' is placed already"),
    # values
    ("negative mass", "mass: 5 t", "mass: @-5 t", "negative mass: bodies.trailer.mass is -5000; it must not be below 0"),
    (
        "negative inertia",
        "5 t, pitch_inertia: 9000",
        "5 t, pitch_inertia: @-9000",
        "negative pitch_inertia: bodies.trailer.pitch_inertia is -9000",
    ),
    ("negative by a symbol", "8000 kg, m", "-8000 kg, m", None),
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
    ("range of what follows", "3.46 m - b1,", "3.46 m - b1, range: [1 m, 3 m],", None),
    ("value and equals", "3.46 m - b1,", "3.46 m - b1, value: 2 m,", None),
    ("neither value nor equals", "value: 200 kN/m, ", "", None),
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
    ("set of what follows", "kF: 150 kN/m", "@b2: 1 m", "a set changes parameters that have a `value`; 'b2' is none; known: b1, kF, mB"),
    ("set with symbols", "kF: 150 kN/m", "kF: @0.5*kF", "a set lists plain quantities, not expressions of parameters"),
    ("set of a wrong value", "kF: 150 kN/m", "kF: -1 N/m", None),
    ("set of no entries", "soft: {kF: 150 kN/m}", "soft: @5", "expected `key: value` entries"),
    # circles
    ("equals itself", "3.46 m - b1", "@3.46 m - b2", "circular `equals`: b2 -> b2"),
    ("hinges in a loop", "hinges:\n", "hinges:\n  first: {trailer: {x: 1 m}, frame: {x: 1 m}}\n", None),
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
    ("underscore", "3.46 m - b1", "3.46 m - @__import__", "a name may not start with an underscore: '__import__'"),
    ("power of a symbol", "3.46 m - b1", "@b1**b1", "an exponent must be a plain number between -10 and 10"),
    ("a list for a number", "mass: 5 t", "mass: @[5 t]", "expected a number with its unit or an expression, such as '3.46 m - b1'"),
    ("a truth for a number", "mass: 5 t", "mass: @true", "expected a number with its unit or an expression"),
    ("nothing for a number", "mass: 5 t", "@mass: null", None),
    # keys that lack
    ("no tyre", "rear: {body: frame, x: -b2, tyre: {k: 1 MN/m}}", "@rear: {body: frame, x: -b2}", "axles.rear lacks the key 'tyre'"),
    ("no mass", "trailer: {mass: 5 t, ", "@trailer: {", "bodies.trailer lacks the key 'mass'"),
    ("no suspension", "suspension: {k: kF, c: 5 kN s/m}, ", "", None),
    ("no axle mass", "mass: 600 kg, ", "", None),
    ("no body at all", GOOD[GOOD.index("bodies:") :], "@bodies: {}\n", "a vehicle needs at least one body"),
    ("bodies of nothing", GOOD[GOOD.index("bodies:") :], "@bodies:\n", "expected `key: value` entries"),
    ("no bodies", GOOD[GOOD.index("bodies:") :], "", None),
]

# messages whose place is not in the text that changes
ELSEWHERE = {
    "no unit in a stiffness": ("15:61", "missing unit: axles.front.suspension.k must be in N/m, found no unit in 'kF'; give 'kF' its unit"),
    "no unit in a value that has a range": ("16:26", "missing unit: axles.rear.x must be in m, found no unit in '-b2'; give 'b2' its unit"),
    "hinge of three": ("13:8", "a hinge or link joins two bodies, each named with its point; found frame, trailer, cab"),
    "hinge to a heaver": ("13:33", "a hinged body needs heave and pitch of its own and no carrier; 'trailer' has not"),
    "link to nothing": ("20:11", "a hinge or link joins two bodies, each named with its point; found trailer"),
    "no motion, no carrier": ("11:3", "body 'load' has no motions and nothing carries it; give it `carried_by`"),
    "negative by a symbol": ("8:17", "negative mass: bodies.frame.mass is -8000"),
    "range of what follows": ("5:7", "a parameter with `equals` follows others; its `range` belongs to them"),
    "value and equals": ("5:7", "a parameter has either `value` or `equals`"),
    "neither value nor equals": ("6:7", "a parameter has either `value` or `equals`"),
    "set of a wrong value": ("15:61", "negative k: axles.front.suspension.k is -1 in the set 'soft'; it must not be below 0"),
    "hinges in a loop": ("14:3", "a loop of hinges: 'frame' and 'trailer' are already joined through other hinges; use a link instead"),
    "nothing for a number": ("9:19", "expected a number with its unit or an expression"),
    "no suspension": ("15:10", "an axle has `mass` and `suspension`, or neither (then its wheel sits on the body); suspension is missing"),
    "no axle mass": ("15:10", "an axle has `mass` and `suspension`, or neither (then its wheel sits on the body); mass is missing"),
    "no bodies": ("1:1", "the file lacks the key 'bodies'"),
}


def test_the_good_file_is_good():
    vehicle = parse_vehicle(GOOD)
    assert vehicle.all_values(vehicle.values("soft")) == {"mB": 8000.0, "b1": 1.32, "b2": 3.46 - 1.32, "kF": 150000.0}


@pytest.mark.parametrize(("old", "new", "message"), [case[1:] for case in CASES], ids=[case[0] for case in CASES])
def test_fault(old: str, new: str, message: str | None, request: pytest.FixtureRequest):
    assert old in GOOD
    text = GOOD.replace(old, new, 1)
    if message is None:
        place, message = ELSEWHERE[request.node.callspec.id]
        text = text.replace("@", "")
    else:
        before, _, after = text.partition("@")
        place = f"{before.count(chr(10)) + 1}:{len(before) - before.rfind(chr(10))}"
        text = before + after
    with pytest.raises(InputError) as caught:
        parse_vehicle(text, "bad.yaml")
    assert str(caught.value).startswith(f"bad.yaml:{place}: {message}")
    assert "\n" not in str(caught.value)


def test_each_case_has_its_own_name():
    assert len({case[0] for case in CASES}) == len(CASES)
    assert {case[0] for case in CASES if case[3] is None} == set(ELSEWHERE)


def test_a_circle_of_three_parameters():
    text = GOOD.replace("value: 200 kN/m", "equals: b3 * 1 kN/m^2").replace("bodies:\n", "  b3: {equals: kF * 1 m^2/kN + b1}\nbodies:\n", 1)
    with pytest.raises(InputError, match=r"bad\.yaml:7:16: circular `equals`: kF -> b3 -> kF$"):
        parse_vehicle(text, "bad.yaml")


def test_a_circle_that_is_reached_through_a_value():
    """A parameter that follows one whose `value` names itself."""
    text = GOOD.replace("b2: {equals: 3.46 m - b1", "b2: {equals: b3").replace("bodies:\n", "  b3: {value: b3}\nbodies:\n", 1)
    with pytest.raises(InputError, match=r"bad\.yaml:7:15: `value` is a plain quantity"):
        parse_vehicle(text, "bad.yaml")


def test_a_circle_of_two_carriers():
    text = GOOD.replace("frame: {mass: mB,", "frame: {mass: mB, carried_by: {body: cab},").replace("hinges:\n  pin", "x_hinges:\n  pin")
    text = text[: text.index("x_hinges")] + text[text.index("axles:") :]
    with pytest.raises(InputError, match=r"bad\.yaml:8:33: bodies carry each other in a circle: frame -> cab -> frame$"):
        parse_vehicle(text, "bad.yaml")


def test_a_loop_of_three_hinges():
    text = GOOD.replace("  cab: {", "  dolly: {mass: 1 t, pitch_inertia: 500 kg m^2}\n  cab: {").replace(
        "axles:\n", "  bar: {trailer: {x: -3 m}, dolly: {x: 1 m}}\n  loop: {dolly: {x: 2 m}, frame: {x: 1 m}}\naxles:\n"
    )
    with pytest.raises(InputError, match=r"bad\.yaml:16:3: a loop of hinges: 'dolly' and 'frame' are already joined"):
        parse_vehicle(text, "bad.yaml")


def test_parameters_that_follow_one_another_in_a_net_are_checked_once_each():
    """Each follows the two before it: checking every path would take 2^30 steps."""
    lines = "".join(f"  f{i}: {{equals: f{i - 1} + f{i - 2}}}\n" for i in range(2, 45))
    text = GOOD.replace("bodies:\n", "  f0: {value: 1 mm}\n  f1: {value: 1 mm}\n" + lines + "bodies:\n", 1)
    start = time.perf_counter()
    vehicle = parse_vehicle(text)
    assert time.perf_counter() - start < 1.0
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


def test_a_second_body_far_away_may_be_placed_once():
    apart = GOOD[: GOOD.index("hinges:")] + GOOD[GOOD.index("axles:") :]
    placed = apart.replace("trailer: {mass", "trailer: {at: -6 m, mass")
    assert str(parse_vehicle(placed).bodies["trailer"].at) == "-6 m"
    with pytest.raises(InputError, match=r"bad\.yaml:11:10: body 'load' is placed already"):
        parse_vehicle(placed.replace("load: {mass", "load: {at: -7 m, mass"), "bad.yaml")


def test_points_written_out_must_be_two_as_well():
    for points, found in (("{a: {}}", "a"), ("{frame: {}, trailer: {}, cab: {}}", "frame, trailer, cab"), ("{}", "none")):
        text = GOOD.replace("{frame: {x: -2 m, z: 0}, trailer: {x: 3 m, z: 0}, k: 1 kN m/rad}", f"{{points: {points}}}")
        with pytest.raises(
            InputError, match=rf"bad\.yaml:13:8: a hinge or link joins two bodies, each named with its point; found {found}$"
        ):
            parse_vehicle(text, "bad.yaml")


def test_sets_and_overrides_that_are_not_there():
    vehicle = parse_vehicle(GOOD)
    with pytest.raises(InputError, match=r"^rig has no parameter set 'sfot'; did you mean 'soft'\?$"):
        vehicle.values("sfot")
    with pytest.raises(InputError, match=r"^rig has no parameter 'b2' with a value; known: b1, kF, mB$"):
        vehicle.values(overrides={"b2": 1.0})
    with pytest.raises(InputError, match=r"^no file trcktor5, and no bundled model 'trcktor5'; did you mean 'tractor5'"):
        load_vehicle("trcktor5")


def test_values_of_a_population_are_checked_too():
    vehicle = parse_vehicle(GOOD, "good.yaml")
    check_values(vehicle, vehicle.values())
    with pytest.raises(InputError, match=r"^good\.yaml:8:17: negative mass: bodies\.frame\.mass is -1 here; it must not be below 0$"):
        check_values(vehicle, vehicle.values(overrides={"mB": -1.0}), " here")
    with pytest.raises(InputError, match=r"^good\.yaml:8:17: bodies\.frame\.mass is not a finite number$"):
        check_values(vehicle, vehicle.values(overrides={"mB": float("nan")}))
