"""What stands on, carries and joins what: bodies, axles, hinges and links, and circles among them."""

from __future__ import annotations

import pytest

from tests.vehicle.rig import GOOD, Fault, check_refused, name_of
from vehgen.errors import InputError
from vehgen.mechanics import derive
from vehgen.vehicle import parse_vehicle

FAULTS: list[Fault] = [
    # connections
    ("axle on no body", "front: {body: frame", "front: {body: @frmae", "no body 'frmae'; did you mean 'frame'?"),
    ("axle on the ground", "front: {body: frame", "front: {body: @ground", "no body 'ground'; known: cab, frame, load, trailer"),
    ("axle on nothing", "front: {body: frame,", "@front: {", "axles.front lacks the key 'body'"),
    ("hinge to no body", "trailer: {x: 3 m, z: 0}", "@trialer: {x: 3 m, z: 0}", "no body 'trialer'; did you mean 'trailer'?"),
    ("hinge to the ground", "trailer: {x: 3 m, z: 0}", "@ground: {}", "no body 'ground'"),
    (
        "hinge of three",
        "trailer: {x: 3 m, z: 0}",
        "trailer: {}, cab: {}",
        "13:8: a hinge or link joins two bodies, each named with its point; found frame, trailer, cab",
    ),
    (
        "hinge to a rider",
        "trailer: {x: 3 m, z: 0}",
        "@cab: {}",
        "a hinged body needs heave and pitch of its own and no carrier; 'cab' has not",
    ),
    (
        "hinge to a heaver",
        "{mass: 5 t,",
        "{motions: [heave], mass: 5 t,",
        "13:33: a hinged body needs heave and pitch of its own and no carrier; 'trailer' has not",
    ),
    ("link to no body", "cab: {x: 0 m}", "@cap: {x: 0 m}", "no body 'cap'; did you mean 'cab'?"),
    ("link to nothing", "ground: {}, ", "", "20:11: a hinge or link joins two bodies, each named with its point; found trailer"),
    ("carried by no body", "carried_by: {body: frame", "carried_by: {body: @fram", "no body 'fram'; did you mean 'frame'?"),
    ("carried by itself", "carried_by: {body: frame", "carried_by: @{body: cab", "bodies carry each other in a circle: cab -> cab"),
    (
        "no motion, no carrier",
        "carried_by: {body: trailer, x: 0 m, z: 1 m}",
        "title: a",
        "11:3: body 'load' has no motions and nothing carries it; give it `carried_by`",
    ),
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
    (
        "hinges in a loop",
        "hinges:\n",
        "hinges:\n  first: {trailer: {x: 1 m}, frame: {x: 1 m}}\n",
        "14:3: a loop of hinges: 'frame' and 'trailer' are already joined through other hinges; use a link instead",
    ),
]


@pytest.mark.parametrize("fault", FAULTS, ids=name_of)
def test_a_fault_of_connections(fault: Fault):
    check_refused(*fault[1:])


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


def test_a_body_that_nothing_connects_needs_a_place():
    text = GOOD[: GOOD.index("hinges:")] + GOOD[GOOD.index("axles:") :].replace(
        "  shaker: {ground: {}, trailer", "  shaker: {ground: {}, frame"
    )
    with pytest.raises(InputError, match=r"bad\.yaml:9:3: nothing connects body 'trailer'"):
        derive(parse_vehicle(text, "bad.yaml"))
    placed = derive(parse_vehicle(text.replace("trailer: {mass", "trailer: {at: -6 m, mass")))
    assert ("heave", "trailer") in [(item.motion, item.owner) for item in placed.coordinates]
