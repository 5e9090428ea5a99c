"""Keys that are unknown or lack, and what may not be a name: refused where it stands, with what would be right."""

from __future__ import annotations

import pytest

from tests.vehicle.rig import GOOD, Fault, check_refused, name_of
from vehgen.errors import InputError
from vehgen.vehicle import parse_vehicle

FAULTS: list[Fault] = [
    # unknown keys, with the nearest valid one
    ("body key", "{mass: mB,", "{@masss: mB,", "unknown key 'masss'; did you mean 'mass'?"),
    (
        "comma in a text",
        "meaning: body mass}",
        "meaning: body mass, @weighed}",
        "unknown key 'weighed'; known: equals, meaning, range, value; quote a text that has a comma within { }",
    ),
    (
        "decimal comma",
        "8000 kg, meaning",
        "8,@5 t, meaning",
        "unknown key '5 t'; known: equals, meaning, range, value; decimals take a point",
    ),
    (
        "a run",
        "links:",
        "@vehicle: other.yaml\nlinks:",
        "unknown key 'vehicle'; known: axles, bodies, description, extends, gravity, hinges, links, name, parameters, sets, "
        "silence, source, title; this looks like a run file",
    ),
    ("tab", "  mount: {", "@\t  mount: {", "not valid YAML: found character '\\t' that cannot start any token; indent by spaces"),
    ("axle key", "x: b1, mass", "@y: b1, mass", "unknown key 'y'; known: body, mass, suspension, title, tyre, x"),
    ("spring key", "{k: kF, c", "{@stiffness: kF, c", "unknown key 'stiffness'; known: c, k"),
    ("point key", "frame: {x: -2 m, z: 0}", "frame: {x: -2 m, @y: 0}", "unknown key 'y'; known: x, z"),
    ("link's point key", "cab: {x: 0 m}", "cab: {@xx: 0 m}", "unknown key 'xx'; did you mean 'x'?"),
    ("carrier key", "frame, x: 1 m, z: 1 m", "frame, x: 1 m, @zz: 1 m", "unknown key 'zz'; did you mean 'z'?"),
    ("size key", "height: 1 m", "@hight: 1 m", "unknown key 'hight'; did you mean 'height'?"),
    ("parameter key", "8000 kg, meaning", "8000 kg, @meanning", "unknown key 'meanning'; did you mean 'meaning'?"),
    ("top key", "links:", "@link:", "unknown key 'link'; did you mean 'links'?"),
    ("merge key", "{mass: 5 t,", "{@<<: {}, mass: 5 t,", "unknown key '<<'; known: "),
    # keys that lack
    ("no tyre", "rear: {body: frame, x: -b2, tyre: {k: 1 MN/m}}", "@rear: {body: frame, x: -b2}", "axles.rear lacks the key 'tyre'"),
    ("no mass", "trailer: {mass: 5 t, ", "@trailer: {", "bodies.trailer lacks the key 'mass'"),
    (
        "no suspension",
        "suspension: {k: kF, c: 5 kN s/m}, ",
        "",
        "15:10: an axle has `mass` and `suspension`, or neither (then its wheel sits on the body); suspension is missing",
    ),
    (
        "no axle mass",
        "mass: 600 kg, ",
        "",
        "15:10: an axle has `mass` and `suspension`, or neither (then its wheel sits on the body); mass is missing",
    ),
    ("no body at all", GOOD[GOOD.index("bodies:") :], "@bodies: {}\n", "a vehicle needs at least one body"),
    ("bodies of nothing", GOOD[GOOD.index("bodies:") :], "@bodies:\n", "expected `key: value` entries"),
    ("no bodies", GOOD[GOOD.index("bodies:") :], "", "1:1: the file lacks the key 'bodies'"),
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
]


@pytest.mark.parametrize("fault", FAULTS, ids=name_of)
def test_a_fault_of_keys_or_names(fault: Fault):
    check_refused(*fault[1:])


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("{mass: 5 t,", "{weighed: null, mass: 5 t,"),
        ("links:", "weighed:\nlinks:"),
        ("frame: {mass: mB, pitch_inertia: 9000 kg m^2}", "frame:\n    mass: mB\n    weighed:\n    pitch_inertia: 9000 kg m^2"),
    ],
)
def test_a_key_without_a_value_is_no_text_with_a_comma(old, new):
    with pytest.raises(InputError, match="unknown key 'weighed'") as caught:
        parse_vehicle(GOOD.replace(old, new), "bad.yaml")
    assert "comma" not in str(caught.value)
