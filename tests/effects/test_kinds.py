"""How each kind of effect acts: where it lives, what it adds to a fit, what it costs, where its fits begin."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from vehgen.effects import EFFECTS, EffectLocator, LineEffect, RunEffect, VehicleEffect, WheelEffect, registry
from vehgen.effects.evidence import Origins, PlaceEvidence
from vehgen.errors import InputError
from vehgen.fit.adjustments import Adjustment
from vehgen.vehicle import load_vehicle

FRICTION, GAIN, SPEED, ENGINE, WHEEL = (
    EFFECTS[name] for name in ("dry_friction", "sensor_gain", "speed_error", "engine_harmonic", "wheel_runout")
)


def point(number):
    return np.array([number]), np.zeros(0)


def found(parts=(), kinds=(), one_force=True, sensors=(), steady_lines=False):
    return PlaceEvidence(frozenset(parts), frozenset(kinds), one_force, frozenset(sensors), steady_lines)


def test_the_library_has_all_kinds_and_each_costs_its_numbers():
    kinds = [VehicleEffect, RunEffect, LineEffect, WheelEffect]
    assert [sum(isinstance(effect, kind) for effect in EFFECTS.values()) for kind in kinds] == [20, 6, 1, 1]
    assert FRICTION.n_numbers(3) == FRICTION.n_numbers(9) == 1
    assert EFFECTS["tyre_liftoff"].n_numbers(3) == 0
    assert GAIN.n_numbers(3) == 1
    assert ENGINE.n_numbers(3) == 2 + 3 * 4
    assert WHEEL.n_numbers(3) == 1 + 3 * 6


def test_only_effects_of_the_vehicle_add_to_its_file():
    vehicle = load_vehicle("tractor5")
    locator = EffectLocator(vehicle, vehicle.values())
    for effect in EFFECTS.values():
        place = next(iter(effect.places(vehicle, ())), "axle1")
        assert bool(effect.change(locator.site(place))) == effect.changes_vehicle


def test_fits_begin_where_what_they_add_was_not_absorbed():
    filed, placed, fitted = point(0.1), point(0.2), point(0.3)
    origins = Origins(filed, placed, fitted)
    assert FRICTION.origins(origins) == [placed, fitted]
    assert GAIN.origins(origins) == [placed, fitted]
    assert SPEED.origins(origins) == [filed, fitted]
    assert ENGINE.origins(origins) == [fitted]
    assert WHEEL.origins(origins) == [placed, fitted]
    assert FRICTION.origins(Origins(fitted, fitted, fitted)) == [fitted]


@pytest.mark.parametrize(
    ("name", "place", "evidence", "likely"),
    [
        ("dry_friction", "rear", found(parts=["rear"]), True),
        ("dry_friction", "rear", found(parts=["front"]), False),
        ("dry_friction", "rear", found(parts=["front"], one_force=False), False),
        ("dry_friction", "all suspensions", found(parts=["rear"]), False),
        ("dry_friction", "all suspensions", found(parts=["body"], one_force=False), True),
        ("dry_friction", "axle4 and axle5", found(parts=["axle5"], one_force=False), True),
        ("dry_friction", "axle4 and axle5", found(parts=["axle2"], one_force=False), False),
        ("walking_beam", "axle4+axle5", found(parts=["axle5"]), True),
        ("cargo_module", "semitrailer", found(parts=["axle1"], one_force=False), True),
        ("cargo_module", "semitrailer", found(parts=["axle1"]), False),
        ("tyre_damping", "all tyres", found(parts=["axle1"], kinds=["tyre"]), True),
        ("tyre_damping", "all tyres", found(parts=["axle1"], kinds=["suspension"]), False),
        ("tyre_footprint", "all tyres", found(kinds=["suspension"], one_force=False), True),
        ("speed_error", "all runs", found(parts=["axle1"], one_force=False), True),
        ("speed_error", "all runs", found(parts=["axle1"]), False),
        ("sensor_gain", "F_az", found(sensors=["F", "F_az"]), True),
        ("sensor_gain", "F_az", found(parts=["F_az"], one_force=False, sensors=["F_q"]), False),
        ("engine_harmonic", "body", found(parts=["rear"], one_force=False), False),
        ("wheel_runout", "rear", found(parts=["rear"], kinds=["suspension"]), True),
        ("wheel_runout", "rear", found(parts=["front"], one_force=False), False),
        ("wheel_runout", "rear", found(parts=["front"], steady_lines=True), True),
    ],
)
def test_a_place_test_speaks_for_the_effects_that_it_can_see(name, place, evidence, likely):
    assert EFFECTS[name].is_likely(place, evidence) == likely


def test_wheels_turn_on_roads_alone():
    vehicle = load_vehicle("tractor5")
    rolling, standing = (SimpleNamespace(scenario=SimpleNamespace(top_speed=speed)) for speed in (2.0, 0.0))
    assert WHEEL.places(vehicle, [standing, rolling]) == tuple(vehicle.axles)
    assert WHEEL.places(vehicle, [standing]) == ()


def test_an_effect_made_global_is_tried_wherever_one_force_does_not_suffice():
    everywhere = replace(FRICTION, is_global=True)
    assert everywhere.is_likely("rear", found(parts=["front"], one_force=False))


def test_a_sensor_of_an_axle_has_no_position_to_be_wrong_about():
    point_output = SimpleNamespace(sensor="stroke", output=object())
    trial = SimpleNamespace(recording=SimpleNamespace(channels=[point_output]), channels=("stroke_d",))
    vehicle = load_vehicle("sedan2")
    assert EFFECTS["sensor_position"].places(vehicle, [trial]) == ()
    assert EFFECTS["sensor_delay"].places(vehicle, [trial]) == ("stroke",)
    assert EFFECTS["sensor_gain"].places(vehicle, [trial]) == ("stroke_d",)


def test_wrong_parameters_are_refused_when_an_effect_is_made():
    with pytest.raises(ValueError, match="has a parameter, found none"):
        replace(GAIN, parameters=())
    with pytest.raises(ValueError, match="frequency, drift, amplitude"):
        replace(ENGINE, parameters=ENGINE.parameters[:1])


class Offset(Adjustment):
    """A channel's constant offset."""

    def response(self, trial, response, numbers):
        return response + numbers[0] * np.array([name == self.place for name in trial.channels])


def install(monkeypatch, *effects):
    """Let effects be found as if packages had named them."""
    points = [SimpleNamespace(name=getattr(effect, "name", "none"), load=lambda effect=effect: effect) for effect in effects]
    monkeypatch.setattr(registry, "entry_points", lambda group: points if group == "vehgen.effects" else [])


def test_packages_may_add_effects_of_every_kind_and_global_ones(monkeypatch):
    own = (
        replace(FRICTION, name="rust", is_global=True),
        replace(GAIN, name="offset", adjustment=Offset, neutral=0.0, is_global=True),
        replace(ENGINE, name="fan", looked_for=(8.0, 12.0)),
    )
    install(monkeypatch, *own)
    assert list(registry.library().values())[-3:] == list(own)


def test_what_packages_add_must_be_effects_with_names_of_their_own(monkeypatch):
    install(monkeypatch, FRICTION)
    with pytest.raises(InputError, match="two effects are named 'dry_friction'"):
        registry.library()
    install(monkeypatch, "dry_friction")
    with pytest.raises(InputError, match="is not an Effect"):
        registry.library()


@pytest.mark.parametrize("name", ["dry_friction", "asymmetric_damping", "damper_mount"])
def test_a_group_of_suspensions_changes_as_its_members_do_with_one_set_of_numbers(name):
    vehicle = load_vehicle("tractor5")
    assert [place for place in EFFECTS[name].places(vehicle, ()) if " " in place] == [
        "all suspensions",
        "axle2 and axle3",
        "axle4 and axle5",
    ]
    locator = EffectLocator(vehicle, vehicle.values())
    group = EFFECTS[name].change(locator.site("axle4 and axle5"))
    changed = vehicle.with_changes(group)
    assert len(group["parameters"]) == len(EFFECTS[name].parameters)
    for axle in vehicle.axles:
        alone = vehicle.with_changes(EFFECTS[name].change(locator.site(axle)))
        kinds = [[key for law in item.axles[axle].suspension.laws for key in law] for item in (alone, changed)]
        assert kinds[1] == (kinds[0] if axle in ("axle4", "axle5") else [])
