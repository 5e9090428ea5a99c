"""Sizes of the places at which effects live."""

import pytest

from vehgen.effects import EffectLocator
from vehgen.mechanics import derive, static_loads
from vehgen.vehicle import load_vehicle, parse_vehicle

BOX = """
parameters: {half: {value: 900 kg}}
bodies: {frame: {mass: 2 * half, size: {length: 5 m, height: 1 m}}}
links:
  a: {frame: {x: 2 m}, ground: {x: 2 m}, k: 20 kN/m}
  b: {frame: {x: -2 m}, ground: {x: -2 m}, k: 20 kN/m}
"""


def test_a_body_with_a_size_has_the_pitch_inertia_of_a_box():
    vehicle = parse_vehicle(BOX)
    site = EffectLocator(vehicle, vehicle.values()).site("a")
    assert site.mass == 1800.0
    assert site.inertia == pytest.approx(1800.0 * (5.0**2 + 1.0**2) / 12)


def test_a_body_with_a_pitch_inertia_keeps_it():
    vehicle = load_vehicle("sedan2")
    values = vehicle.all_values(vehicle.values())
    assert EffectLocator(vehicle, vehicle.values()).site("body").inertia == vehicle.bodies["body"].pitch_inertia.evaluate(values)


def test_all_tyres_are_sized_as_their_mean():
    vehicle = load_vehicle("tractor5")
    locator = EffectLocator(vehicle, vehicle.values())
    every, each = locator.site("all tyres"), [locator.site(name) for name in vehicle.axles]
    assert every.kt == pytest.approx(sum(site.kt for site in each) / 5)
    assert every.load == pytest.approx(sum(site.load for site in each) / 5)
    assert min(site.travel for site in each) <= every.travel <= max(site.travel for site in each)


def test_a_group_of_suspensions_is_sized_as_their_mean_and_axles_of_a_beam_as_their_sum():
    vehicle = load_vehicle("tractor5")
    locator = EffectLocator(vehicle, vehicle.values())
    each = [locator.site(name) for name in ("axle4", "axle5")]
    group, beam = locator.site("axle4 and axle5"), locator.site("axle4+axle5")
    assert group.load == pytest.approx(sum(site.load for site in each) / 2)
    assert beam.k == pytest.approx(2 * group.k) == pytest.approx(sum(site.k for site in each))
    assert locator.site("all suspensions").c == pytest.approx(sum(locator.site(name).c for name in vehicle.axles) / 5)


def test_a_hitch_that_carries_little_is_sized_by_the_lighter_body():
    """A stabiliser on a caravan's ball slips at more than 0.4 of its nose load times 1 m."""
    vehicle = load_vehicle("road_train")
    locator, carried = EffectLocator(vehicle, vehicle.values()), static_loads(derive(vehicle), vehicle.values()).hinges
    assert locator.site("fifth_wheel_1").load == pytest.approx(abs(carried["fifth_wheel_1"]))
    assert abs(carried["drawbar_1"]) < 1100
    assert locator.site("drawbar_1").load == pytest.approx(0.1 * 1600 * 9.81)  # of the dolly
