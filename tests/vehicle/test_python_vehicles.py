"""Vehicles made of typed parts in Python, and changes of vehicles wherever they come from."""

from __future__ import annotations

from pathlib import Path

import pytest

from vehgen.errors import InputError
from vehgen.files.expressions import Expression
from vehgen.mechanics import derive
from vehgen.simulate import natural_modes
from vehgen.vehicle import Axle, Body, Hinge, Link, Parameter, Point, Spring, Vehicle, load_vehicle, parse_vehicle

TEXT = """
name: rig
parameters:
  mass: {value: 8 t, range: [6 t, 10 t]}
  reach: {value: 1.5 m}
  back: {equals: 3.4 m - reach}
bodies:
  frame: {mass: mass, pitch_inertia: 9000 kg m^2}
  cab: {mass: 600 kg, motions: [heave], carried_by: {body: frame, x: 1 m}}
axles:
  front: {body: frame, x: reach, mass: 500 kg, suspension: {k: 200 kN/m, c: 9 kN s/m}, tyre: {k: 1 MN/m}}
  rear: {body: frame, x: -back, tyre: {k: 2 MN/m}}
links:
  mount: {frame: {x: 1 m}, cab: {}, k: 100 kN/m, c: 1 kN s/m}
"""


def made() -> Vehicle:
    reach = Expression.symbol("reach")
    return Vehicle(
        name="rig",
        parameters={
            "mass": Parameter(value="8 t", range=("6 t", "10 t")),
            "reach": Parameter(value="1.5 m"),
            "back": Parameter(equals=Expression.quantity(3.4, "m") - reach),
        },
        bodies={
            "frame": Body(mass="mass", pitch_inertia="9000 kg m^2"),
            "cab": Body(mass="600 kg", motions=["heave"], carried_by={"body": "frame", "x": "1 m"}),
        },
        axles={
            "front": Axle(body="frame", x=reach, mass="500 kg", suspension=Spring(k="200 kN/m", c="9 kN s/m"), tyre=Spring(k="1 MN/m")),
            "rear": Axle(body="frame", x="-back", tyre=Spring(k="2 MN/m")),
        },
        links={"mount": Link(frame=Point(x="1 m"), cab=Point(), k="100 kN/m", c="1 kN s/m")},
    )


def frequencies(vehicle: Vehicle) -> list[float]:
    return [mode.undamped_hz for mode in natural_modes(derive(vehicle))]


def test_a_vehicle_of_parts_is_that_of_its_file():
    by_file, by_hand = parse_vehicle(TEXT), made()
    assert by_hand.model_dump() == by_file.model_dump()
    assert by_hand.values() == by_file.values()
    assert frequencies(by_hand) == frequencies(by_file)


CHANGE = {
    "bodies": {"cab": {"mass": "cab_mass"}},
    "parameters": {"cab_mass": {"value": "700 kg"}, "back": {"value": "2 m"}},
    "axles": {"front": {"mass": None, "suspension": None}},
}


def test_a_change_is_what_a_file_that_extends_says():
    extended = parse_vehicle(
        TEXT.replace("mass: 600 kg", "mass: cab_mass").replace("{equals: 3.4 m - reach}", "{value: 2 m}\n  cab_mass: {value: 700 kg}")
    )
    extended = extended.with_changes(axles={"front": {"mass": None, "suspension": None}})
    assert extended.axles["front"].suspension is None
    for vehicle in (parse_vehicle(TEXT), made()):
        changed = vehicle.with_changes(CHANGE)
        assert changed.model_dump() == extended.model_dump()
        assert changed.with_changes({}).model_dump() == extended.model_dump()
        assert vehicle.model_dump() == made().model_dump()


def test_keyword_parts_change_what_they_name_and_typed_parts_replace():
    vehicle = made()
    lighter = vehicle.with_changes(title="light", axles={"front": Axle(body="frame", x="reach", tyre=Spring(k="1 MN/m"))})
    assert lighter.title == "light"
    assert lighter.axles["front"].suspension is None
    assert lighter.axles["rear"] == vehicle.axles["rear"]
    stiffer = vehicle.with_changes(axles={"front": {"tyre": {"k": 2 * vehicle.axles["front"].tyre.k}}})
    assert stiffer.axles["front"].tyre.k.evaluate({}) == 2e6
    assert stiffer.axles["front"].suspension == vehicle.axles["front"].suspension


def test_a_change_keeps_the_places_of_the_file_it_came_from():
    vehicle = load_vehicle("sedan2.yaml").with_changes(title="other")
    assert vehicle.files == load_vehicle("sedan2.yaml").files
    assert vehicle.position("axles") == load_vehicle("sedan2.yaml").position("axles")
    assert str(vehicle.position("title")) == "change.title"


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: Body(mass="8 xt"), "Body.mass: 'xt' after 8 is not a unit; did you mean 't'?"),
        (lambda: Body(masss="8 t"), "Body.masss: unknown key 'masss'; did you mean 'mass'?"),
        (lambda: Body(), "Body: it lacks the key 'mass'"),
        (lambda: Hinge(frame=Point()), "Hinge: a hinge or link joins two bodies"),
        (lambda: Parameter(), "Parameter: a parameter has either `value` or `equals`"),
        (lambda: Vehicle(name="rig", bodies={}), "Vehicle.bodies: a vehicle needs at least one body"),
        (
            lambda: Vehicle(name="rig", bodies={"frame": Body(mass="8 m", motions=["heave"])}),
            "Vehicle.bodies.frame.mass: bodies.frame.mass must be in kg, found m in '8 m'",
        ),
        (lambda: Vehicle(name="rig", bodies={"frame": {"mass": "8 t", "motion": []}}), "Vehicle.bodies.frame.motion: unknown key 'motion'"),
        (lambda: made().with_changes(bodies={"cab": {"mass": "m9"}}), "change.bodies.cab.mass: unknown symbol 'm9'; known: back"),
        (lambda: made().with_changes(parameters={"m9": None}), "change.parameters.m9: None removes 'm9', but the vehicle has none"),
        (lambda: made().with_changes(parameters={"reach": None}), "Vehicle.parameters.back.equals: unknown symbol 'reach'"),
        (lambda: made().with_changes({"title": "a"}, title="b"), "`title` is changed twice"),
    ],
)
def test_what_does_not_fit_is_refused_with_the_path_of_the_argument(make, message: str):
    with pytest.raises(InputError) as caught:
        make()
    assert str(caught.value).startswith(message)


def test_a_change_that_takes_away_what_the_file_uses_is_refused_in_the_file():
    vehicle = parse_vehicle(TEXT, "rig.yaml")
    with pytest.raises(InputError, match=r"^rig.yaml:6:\d+: unknown symbol 'reach'"):
        vehicle.with_changes(parameters={"reach": None})


def test_the_snippet_of_the_page_does_what_the_page_says():
    page = (Path(__file__).parents[2] / "docs" / "vehicle-file.md").read_text(encoding="utf-8")
    snippet = page.partition("```python\n")[2].partition("```")[0]
    made_there: dict[str, Vehicle] = {}
    exec(compile(snippet, "vehicle-file.md", "exec"), made_there)
    laden = made_there["laden"]
    assert laden.axles["rear"].tyre.k.evaluate({}) == 1e6
    assert (laden.title, list(laden.bodies)) == ("laden", ["frame", "load"])
    assert derive(laden).n_dof == 2
