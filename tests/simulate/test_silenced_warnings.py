"""Warnings of a vehicle: silenced by its file, and none for mounts and bending that move as such do."""

import pytest

from vehgen.errors import InputError
from vehgen.mechanics import derive, static_loads
from vehgen.simulate import lint
from vehgen.vehicle import parse_vehicle

SHORT_AXLES = """
bodies: {frame: {mass: 8 t, pitch_inertia: 20 t m^2%s}}
axles:
  one: {body: frame, x: 2 m, tyre: {k: 1 MN/m, c: 5 kN s/m}}
  two: {body: frame, x: -2 m, tyre: {k: 1 MN/m, c: 5 kN s/m}}
  three: {body: frame, x: -2.5 m, tyre: {k: 1 MN/m, c: 5 kN s/m}}
"""
MOUNTED = """
extends: quarter_car
bodies: {engine: {mass: 300 kg, motions: [heave]}}
links: {mount: {body: {}, engine: {}, k: %s}}
"""


def warnings(text: str) -> list[str]:
    return lint(derive(parse_vehicle(text)))


def test_a_file_silences_a_kind_or_one_of_its_parts():
    text = SHORT_AXLES % ""
    assert [item for item in warnings(text) if "overlapping" in item]
    for entry in ("axle_gap", "axle_gap three"):
        assert not [item for item in warnings(text + f"silence: [{entry}]\n") if "overlapping" in item]
    assert warnings(text + "silence: [axle_gap two]\n") == warnings(text)


@pytest.mark.parametrize(
    ("entry", "said"),
    [
        ("gyrations", "unknown warning 'gyrations'; did you mean 'gyration'"),
        ("gyration frme", "no bodies are called 'frme'; did you mean 'frame'"),
        ("gyration one", "no bodies are called 'one'"),
    ],
)
def test_what_cannot_be_silenced_is_refused_at_its_place(entry, said):
    with pytest.raises(InputError, match=said) as caught:
        parse_vehicle(SHORT_AXLES % "" + f"silence: [axle_gap, {entry}]\n")
    assert caught.value.position.line == 7


def test_an_engine_on_its_mounts_may_move_faster_than_a_body():
    assert warnings(MOUNTED % "1.5 MN/m") == []
    (found,) = warnings(MOUNTED % "30 MN/m")
    assert found.startswith("mount mode outside 0.5-30 Hz: engine heave")


def test_bending_is_no_body_mode():
    rigid = SHORT_AXLES % ""
    bent = SHORT_AXLES % ", bending: {frequency: 12 Hz, length: 6 m}"
    assert [item for item in warnings(bent) if "bending" in item] == []
    assert len(warnings(bent)) <= len(warnings(rigid))


CAB = """
extends: sedan2
bodies: {cab: {mass: 200 kg, pitch_inertia: 50 kg m^2}}
links:
  fore: {body: {x: 1 m}, cab: {x: 0.5 m}, k: 100 kN/m}
  aft: {body: {x: 0 m}, cab: {x: %s}, k: 100 kN/m}
"""


def test_a_link_whose_ends_do_not_stand_over_one_another_is_warned_of():
    assert warnings(CAB % "-0.5 m") == []
    (found,) = [item for item in warnings(CAB % "0.5 m") if "ends of the link" in item]
    assert found.startswith("the ends of the link aft stand 1.00 m apart along the vehicle; a link acts vertically")
    assert not [item for item in warnings(CAB % "0.5 m" + "silence: [link_gap aft]\n") if "ends of the link" in item]


@pytest.mark.parametrize(
    ("tyre", "said"), [("k: 1 MN/m", []), ("k: 200 kN/m", ["the tyre of one is pressed in by 0.21 m at rest: too much load or too soft"])]
)
def test_a_load_that_presses_a_tyre_flat_is_told(tyre, said):
    text = SHORT_AXLES.replace("k: 1 MN/m", tyre) % ""
    assert [item for item in warnings(text) if "pressed in" in item and " one " in item] == said
    assert not [item for item in warnings(text + "silence: [deflection one]\n") if "of one is pressed in" in item]


@pytest.mark.parametrize(
    ("law", "newtons"),
    [
        ("{law: {force: 100 N + k3*d**3, parameters: {k3: 1 MN/m^3}}}", "law on the suspension front pushes with 100 N"),
        ("{bump_stop: {k: 100 kN/m, clearance: -10 mm}}", "bump_stop on the suspension front pushes with 1000 N"),
        ("{bump_stop: {k: 100 kN/m, clearance: -10 mm, from: unloaded}}", None),
        ("{hysteresis: {force: 300 N, travel: 5 mm}}", None),
        ("{dry_friction: {force: 300 N}}", None),
    ],
)
def test_a_law_that_pushes_at_rest_is_doubted(law, newtons):
    """Counted from static equilibrium it leaves the vehicle out of balance as a run begins."""
    vehicle = parse_vehicle(f"extends: sedan2\naxles: {{front: {{suspension: {{laws: [{law}]}}}}}}")
    found = [text for text in lint(derive(vehicle)) if "pushes" in text]
    assert [text.partition(" at rest")[0] for text in found] == ([] if newtons is None else [newtons])


CARAVAN = """
bodies: {car: {mass: 1400 kg, pitch_inertia: 2300 kg m^2}, caravan: {mass: 1000 kg, pitch_inertia: 2000 kg m^2}}
hinges: {ball: {%s}}
axles:
  front: {body: car, x: 1.2 m, mass: 80 kg, suspension: {k: 50 kN/m, c: 3 kN s/m}, tyre: {k: 400 kN/m}}
  rear: {body: car, x: -1.5 m, mass: 80 kg, suspension: {k: 60 kN/m, c: 3 kN s/m}, tyre: {k: 400 kN/m}}
  van: {body: caravan, x: %s m, mass: 80 kg, suspension: {k: 70 kN/m, c: 3 kN s/m}, tyre: {k: 400 kN/m}}
"""
ENDS = ("car: {x: -2.6 m}", "caravan: {x: 4 m}")


@pytest.mark.parametrize("ends", [ENDS, ENDS[::-1]], ids=["car first", "caravan first"])
@pytest.mark.parametrize(("axle", "lifted"), [(-0.2, None), (0.1, None), (0.2, "0.516"), (0.4, "1.090")])
def test_a_trailer_that_lifts_what_pulls_it_is_warned_of(ends, axle, lifted):
    """Levers about its axle: m g times the COG's distance behind it over the ball's ahead of it; next to nothing may be meant so."""
    text = CARAVAN % (", ".join(ends), axle)
    found = [item for item in warnings(text) if "lifts" in item]
    assert [item.partition(":")[0] for item in found] == ([f"at ball, caravan lifts car by {lifted} kN"] if lifted else [])
    assert not [item for item in warnings(text + "silence: [lift ball]\n") if "lifts" in item]


BOGIE = """
bodies: {frame: {mass: 9 t, pitch_inertia: 20 t m^2}, bogie: {mass: 900 kg, pitch_inertia: 400 kg m^2}}
hinges: {pivot: {frame: {x: -1.8 m}, bogie: {x: 0.1 m}}}
axles:
  front: {body: frame, x: 2.4 m, mass: 500 kg, suspension: {k: 300 kN/m, c: 9 kN s/m}, tyre: {k: 1.5 MN/m}}
  two: {body: bogie, x: 0.7 m, tyre: {k: 1.5 MN/m, c: 5 kN s/m}}
  three: {body: bogie, x: -0.7 m, tyre: {k: 1.5 MN/m, c: 5 kN s/m}}
"""
ARM = """
bodies: {frame: {mass: 200 kg, pitch_inertia: 30 kg m^2}, arm: {mass: 12 kg, pitch_inertia: 1 kg m^2}}
hinges: {pivot: {frame: {x: -0.2 m}, arm: {x: 0.25 m}}}
links: {shock: {frame: {x: -0.95 m}, arm: {x: -0.5 m}, k: 40 kN/m, c: 1 kN s/m}}
axles:
  front: {body: frame, x: 0.7 m, mass: 16 kg, suspension: {k: 18 kN/m, c: 900 N s/m}, tyre: {k: 170 kN/m}}
  rear: {body: arm, x: -0.25 m, tyre: {k: 180 kN/m, c: 200 N s/m}}
"""


@pytest.mark.parametrize("text", [BOGIE, ARM], ids=["bogie", "arm"])
def test_a_bogie_and_a_sprung_arm_carry_what_is_ahead_of_them(text):
    """Both lift it at their pivots, as they are meant to."""
    model = derive(parse_vehicle(text))
    assert static_loads(model).hinges["pivot"] < 0
    assert not [item for item in lint(model) if "lifts" in item]
