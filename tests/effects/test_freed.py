"""A damper on a soft mount, and the base parameters that effects set free at their place."""

import numpy as np
from scipy.integrate import solve_ivp

from vehgen.codegen import Excitation, Kernel
from vehgen.diagnose.fits.candidate import has_room, list_candidates
from vehgen.effects import EFFECTS, EffectLocator
from vehgen.effects.locator import base_parameters, undamped_tyres
from vehgen.effects.places import dampers
from vehgen.mechanics import Place, PointOutput, derive
from vehgen.vehicle import load_vehicle, parse_vehicle

MOUNT = EFFECTS["damper_mount"]
QUARTER = {"mB": 10000.0, "mG": 1000.0, "kS": 1e6, "cS": 1e4, "kT": 1e6, "cT": 1e4}


def hump(t):
    local = (t - 0.1) / 0.2
    inside = (local > 0) & (local < 1)
    rate = 0.03 * np.pi / 0.2 * np.cos(np.pi * local)
    return np.where(inside, 0.03 * np.sin(np.pi * local), 0.0), np.where(inside, rate, 0.0)


def body_by_hand(k, times):
    """Return the body's acceleration where the dashpot's lower end y (its travel) is a state of its own: c y' = k (d - y)."""
    mB, mG, kS, c, kT, cT = QUARTER.values()

    def rates(t, x):
        zb, zg, vb, vg, y = x
        w, dw = hump(t)
        d = zg - zb
        force = kS * d + k * (d - y)
        return [vb, vg, force / mB, (kT * (w - zg) + cT * (dw - vg) - force) / mG, k * (d - y) / c]

    found = solve_ivp(rates, (0, times[-1]), np.zeros(5), t_eval=times, rtol=1e-9, atol=1e-12, max_step=1e-3).y
    d = found[1] - found[0]
    return (kS * d + k * (d - found[4])) / mB


def body_of(vehicle, values, times):
    model = derive(vehicle, [PointOutput("a", Place("P", "body"), "acceleration")])
    w, dw = hump(times)
    excitation = Excitation(times[1], w[:, None], dw[:, None], np.zeros((len(times), 0)))
    return Kernel(model).run(np.array([list(model.values(overrides=values).values())]), excitation, 1).responses[0, :, 0]


def test_a_mounted_damper_moves_as_one_with_a_state_of_its_own():
    vehicle = load_vehicle("quarter_car")
    site = EffectLocator(vehicle, vehicle.values()).site("axle1")
    changed = vehicle.with_changes(MOUNT.change(site))
    times = np.arange(6001) * 2e-4
    (name,) = MOUNT.search_names("axle1")
    for k in (1e6, 1e5):
        expected = body_by_hand(k, times)
        found = body_of(changed, {name: k}, times)
        assert np.abs(found - expected).max() < 2e-3 * np.abs(expected).max()
    assert np.abs(body_of(vehicle, {}, times) - expected).max() > 0.05 * np.abs(expected).max()


def test_a_hard_mount_is_none():
    vehicle = load_vehicle("quarter_car")
    changed = vehicle.with_changes(MOUNT.change(EffectLocator(vehicle, vehicle.values()).site("axle1")))
    times = np.arange(6001) * 2e-4
    (name,) = MOUNT.search_names("axle1")
    plain, hard = body_of(vehicle, {}, times), body_of(changed, {name: 2e8}, times)
    assert np.abs(hard - plain).max() < 0.02 * np.abs(plain).max()


def test_only_a_suspension_with_a_dashpot_has_a_mount_for_it():
    bare = parse_vehicle("extends: sedan2\naxles:\n  rear: {suspension: {c: 0 N s/m}}\n")
    assert dampers(bare, ()) == ("front",)
    assert dampers(load_vehicle("sedan2"), ()) == ("front", "rear", "all suspensions")


def test_what_is_freed_are_the_parameters_that_the_file_names_there():
    vehicle = parse_vehicle("extends: sedan2\nparameters:\n  both: {equals: 2 * kf}\naxles:\n  rear: {suspension: {k: both}}\n")
    assert base_parameters(vehicle, "rear", ("k", "c")) == ("kf", "cr")
    assert base_parameters(vehicle, "all tyres", ("kt",)) == ("ktf", "ktr")
    assert base_parameters(vehicle, "body", ("k", "c", "kt")) == ()
    assert MOUNT.freed("front", vehicle) == ("cf",)


def test_nothing_is_searched_where_a_mount_has_taken_the_dashpot_away():
    vehicle = load_vehicle("sedan2")
    plain = EffectLocator(vehicle, vehicle.values())
    mounted = vehicle.with_changes(MOUNT.change(plain.site("rear")))
    for place, rooms in (("rear", [True, False]), ("front", [True, True])):
        (candidate,) = [item for item in list_candidates(vehicle, (), [EFFECTS["quadratic_damping"]]) if item.place == place]
        assert [has_room(candidate, locator) for locator in (plain, EffectLocator(mounted, mounted.values()))] == rooms


def test_tyres_without_damping_are_those_whose_axle_or_stiffness_is_searched():
    sedan = load_vehicle("sedan2")
    assert undamped_tyres(sedan, ["mf", "kr"]) == ("front",)
    assert undamped_tyres(sedan, ["mH", "ktr", "ktf"]) == ("front", "rear")
    for zero in ("0 N s/m", "0", "cT"):
        text = {"parameters": {"cT": {"value": "0 N s/m"}}} | {"axles": {"rear": {"tyre": {"c": zero}}}}
        assert undamped_tyres(sedan.with_changes(text), ["mr"]) == ("rear",)
    searched = {"parameters": {"cT": {"value": "0 N s/m", "range": ["0 N s/m", "1 kN s/m"]}}, "axles": {"rear": {"tyre": {"c": "cT"}}}}
    assert undamped_tyres(sedan.with_changes(searched), ["mr"]) == ()
    damped = sedan.with_changes({"axles": {"rear": {"tyre": {"c": "100 N s/m"}}}})
    assert undamped_tyres(damped, ["mr", "ktr"]) == ()
