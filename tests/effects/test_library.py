"""The library of effects."""

import importlib
import importlib.util
import pkgutil
import re
from pathlib import Path

import numpy as np
import pytest
import sympy as sp

from tests.bundled import few
from vehgen.effects import EFFECTS, Effect, EffectLocator
from vehgen.effects.base import one
from vehgen.files.yaml_writer import yaml_document
from vehgen.fit.trial import load_trials
from vehgen.mechanics import Place, PointOutput, derive
from vehgen.simulate import SimulatorPool, natural_modes
from vehgen.vehicle import load_vehicle, parse_vehicle

DOCS = Path(__file__).parents[2] / "docs"


def test_the_library_holds_the_effect_of_every_file_in_its_folder():
    folder = importlib.import_module("vehgen.effects.library")
    modules = [importlib.import_module(f"{folder.__name__}.{item.name}") for item in pkgutil.iter_modules(folder.__path__)]
    written = {id(value): module for module in modules for value in vars(module).values() if isinstance(value, Effect)}
    assert set(written) == {id(effect) for effect in EFFECTS.values()}
    assert all(vars(written[id(effect)])[f"{name.upper()}_EFFECT"] is effect for name, effect in EFFECTS.items())


@pytest.mark.parametrize("effect", EFFECTS.values(), ids=list(EFFECTS))
def test_every_effect_says_what_it_is_and_begins_within_its_range(effect):
    assert all((effect.title, effect.equation, effect.meaning, effect.signature, effect.source, effect.attaches))
    for parameter in effect.parameters:
        assert parameter.low < parameter.high
        assert all(parameter.low <= start <= parameter.high for start in parameter.starts)
        assert parameter.meaning


@pytest.mark.parametrize("name", few(("sedan2", "tractor5", "road_train", "truck_dolly_trailer")))
def test_every_edit_gives_a_vehicle_that_vehgen_accepts(name):
    vehicle = load_vehicle(f"{name}.yaml")
    locator = EffectLocator(vehicle, vehicle.values())
    for effect in EFFECTS.values():
        for place in effect.places(vehicle, ())[:2] if effect.changes_vehicle else ():
            change = effect.change(locator.site(place))
            changed = vehicle.with_changes(change)
            written = parse_vehicle(yaml_document({"extends": name, **change}))
            assert (written.bodies, written.axles, written.parameters) == (changed.bodies, changed.axles, changed.parameters)
            assert set(effect.search_names(place)) <= set(changed.ranges())
            assert derive(changed).n_dof >= derive(vehicle).n_dof


def test_every_edit_fits_a_vehicle_with_the_longest_names():
    """Effects name their parts and parameters after the place; what would be too long is cut and stays one of its own."""
    base = load_vehicle("truck_dolly_trailer")
    parts = {name: f"{name}_".ljust(64, "x") for name in (*base.bodies, *base.hinges, *base.axles, *base.links)}
    text = Path(base.files[0]).read_text(encoding="utf-8")
    vehicle = parse_vehicle(re.sub(r"\w+", lambda match: parts.get(match[0], match[0]), text))
    assert set(vehicle.bodies) == {parts[name] for name in base.bodies}
    locator = EffectLocator(vehicle, vehicle.values())
    for effect in EFFECTS.values():
        if effect.changes_vehicle:
            names = [name for place in effect.places(vehicle, ()) for name in effect.at(place, vehicle).search_names(place)]
            assert len(set(names)) == len(names)
            for place in (*effect.places(vehicle, ())[:1], *effect.places(vehicle, ())[-1:]):
                vehicle.with_changes(effect.at(place, vehicle).change(locator.site(place)))


def frequencies(vehicle):
    return np.array([mode.undamped_hz for mode in natural_modes(derive(vehicle))])


def test_a_walking_beam_leaves_the_tandem_its_heave_and_takes_its_pitch_stiffness():
    vehicle = load_vehicle("tractor5.yaml")
    site = EffectLocator(vehicle, vehicle.values()).site("axle4+axle5")
    changed = derive(vehicle.with_changes(EFFECTS["walking_beam"].change(site, {"share": 1.0, "split": 0.5})))
    K = changed.numeric().K
    beam = [item.name for item in changed.coordinates]
    pitch = beam.index("pitch.beam_axle4_axle5")
    kt, half, m4, m5 = (2689.24 * 8000, 808.0 * 8000), 0.615, 0.57, 0.34
    offset = half * (m4 - m5) / (m4 + m5)
    springs = kt[0] * (half - offset) ** 2 + kt[1] * (half + offset) ** 2 + site.k * offset**2
    assert K[pitch, pitch] == pytest.approx(springs, rel=1e-9)


def test_each_tyre_has_its_own_damping_or_all_share_a_ratio():
    vehicle = load_vehicle("sedan2")
    locator, damping = EffectLocator(vehicle, vehicle.values()), EFFECTS["tyre_damping"]
    own = damping.at("each tyre", vehicle)
    assert [item.name for item in own.parameters] == ["ratio_front", "ratio_rear"]
    assert own.n_numbers(5) == 2
    changed = vehicle.with_changes(own.change(locator.site("each tyre"), {"ratio_front": 0.02, "ratio_rear": 0.1}))
    values = changed.all_values(changed.values())
    for name, ratio, k, m in (("front", 0.02, 448.76 * 1500, 90), ("rear", 0.1, 408.65 * 1500, 150)):
        assert changed.axles[name].tyre.c.evaluate(values) == pytest.approx(2 * ratio * np.sqrt(k * m))
    assert damping.at("all tyres", vehicle).n_numbers(5) == damping.at("front", vehicle).n_numbers(5) == 1
    assert "each tyre" not in damping.places(load_vehicle("quarter_car"), ())


def test_a_light_load_leaves_the_body_modes_nearly_alone():
    vehicle = load_vehicle("sedan2.yaml")
    site = EffectLocator(vehicle, vehicle.values()).site("body")
    values = {"mass": 15.0, "frequency": 12.0, "damping_ratio": 0.02, "x": 0.0}
    changed = vehicle.with_changes(EFFECTS["cargo_module"].change(site, values))
    found = frequencies(changed)
    assert np.delete(found, np.abs(found - 12.0).argmin()) == pytest.approx(frequencies(vehicle), rel=0.02)


BEAM = """
parameters: {mB: {value: 1000 kg}, IB: {value: 8333.333333333334 kg m^2}}
bodies: {beam: {mass: mB, pitch_inertia: IB, bending: {length: 10 m, frequency: %s Hz, damping_ratio: 0.01}}}
links:
  a: {beam: {x: 5 m}, ground: {x: 5 m}, k: %s N/m}
  b: {beam: {x: -5 m}, ground: {x: -5 m}, k: %s N/m}
"""


def test_a_free_beam_bends_at_its_frequency():
    assert frequencies(parse_vehicle(BEAM % (5, 1, 1)))[-1] == pytest.approx(5.0, rel=1e-4)


def test_bending_follows_the_hand_calculation_of_two_degrees_of_freedom():
    k, m, w = 4e5, 1000.0, 2 * np.pi * 5
    M, K = np.diag([m, m / 5]), np.array([[2 * k, 2 * k], [2 * k, 2 * k + w**2 * m / 5]])
    by_hand = np.sqrt(np.sort(np.linalg.eigvals(np.linalg.solve(M, K)).real)) / (2 * np.pi)
    found = frequencies(parse_vehicle(BEAM % (5, k, k)))
    assert all(np.abs(found - hz).min() < 1e-8 for hz in by_hand)


def test_a_stiff_frame_is_a_rigid_one():
    change = {"bodies": {"semitrailer": {"bending": {"length": "12 m", "frequency": "3000 Hz"}}}}
    vehicle = load_vehicle("tractor5.yaml")
    assert frequencies(vehicle.with_changes(change))[:-1] == pytest.approx(frequencies(vehicle), rel=1e-5)


def test_a_bending_frame_leaves_its_pin_where_it_is_fore_and_aft():
    """A trailer hangs by its frame: what bends the frame turns the pin, and pushes no tractor."""
    vehicle = load_vehicle("tractor5.yaml")
    site = EffectLocator(vehicle, vehicle.values()).site("semitrailer")
    motion = derive(vehicle.with_changes(EFFECTS["frame_bending"].change(site))).motion
    x, z = (sp.Symbol(name, real=True) for name in ("b6", "a2"))
    bending = motion.index("bending.semitrailer")
    pin, above = motion.forward("semitrailer", x, z), motion.forward("semitrailer", x, z + 1)
    assert pin.get(bending, 0) == 0
    assert sp.simplify(above[bending] - motion.turn("semitrailer", x)[bending]) == 0
    assert bending not in motion.fore_aft["tractor"]
    assert bending not in motion.fore_aft["semitrailer"]


def test_the_page_shows_the_library_as_it_is():
    spec = importlib.util.spec_from_file_location("make_effects_page", DOCS / "generate/effects_page.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    assert module.page() == (DOCS / "effects.md").read_text(encoding="utf-8")


def test_a_walking_beam_is_no_place_for_cargo_and_takes_its_axles_suspensions_away():
    vehicle = load_vehicle("tractor5.yaml")
    site = EffectLocator(vehicle, vehicle.values()).site("axle2+axle3")
    changed = vehicle.with_changes(EFFECTS["walking_beam"].change(site))
    assert "beam_axle2_axle3" in changed.bodies
    for effect in (item for item in EFFECTS.values() if item.attaches == "body"):
        assert effect.places(changed, ()) == effect.places(vehicle, ())
    assert {"axle1", "axle4", "axle5"} == set(EFFECTS["dry_friction"].places(changed, ())) & set(vehicle.axles)


def test_every_scaled_parameter_says_what_its_range_is_a_multiple_of():
    for effect in EFFECTS.values():
        for item in effect.parameters:
            assert bool(item.of) == (item.scale is not one), (effect.name, item.name)
    assert EFFECTS["dry_friction"].parameters[0].searched == "0.002 to 0.4 times the static load"


TANDEM_RUN = """
vehicle: tractor5.yaml
speed: 2 m/s
road:
  - hump: {shape: half_sine, length: 0.5 m, height: 0.03 m, at: 3 m}
sensors:
  A4: {axle: axle4, channels: {acceleration: A4_az}}
recording: run.csv
"""


def trials_of_a_tandem(folder, text):
    columns = sorted(set(re.findall(r"A\d_\w+", text)))
    time = np.arange(0.0, 12.0, 0.01)
    table = np.column_stack([time, *(np.sin(9.0 * time + i) for i in range(len(columns)))])
    np.savetxt(folder / "run.csv", table, delimiter=",", header=",".join(["t", *columns]), comments="")
    (folder / "run.yaml").write_text(text, encoding="utf-8")
    return load_trials([folder / "run.yaml"])


def test_a_sensor_on_an_axle_moves_with_the_beam_that_a_tandem_may_have(tmp_path):
    """A diagnosis with a sensor on an axle of a tandem ended with a refusal of that sensor."""
    trials = trials_of_a_tandem(tmp_path, TANDEM_RUN)
    vehicle, beam = trials[0].run.vehicle, EFFECTS["walking_beam"]
    assert beam.places(vehicle, trials) == ("axle2+axle3", "axle4+axle5")
    (changed,) = beam.change_trials(trials, "axle4+axle5", EffectLocator(vehicle, vehicle.values()), SimulatorPool())
    end = PointOutput("end", Place("end", "beam_axle4_axle5", behind="axle4"), "acceleration")
    found, expected = (
        dict(zip((row := model.channels[0].acceleration), model.evaluate_list(row.values(), model.values()), strict=True))
        for model in (changed.simulator.model, derive(changed.run.vehicle, [end]))
    )
    assert found == pytest.approx(expected)
    assert len(found) > 1


@pytest.mark.parametrize(
    ("was", "becomes"),
    [
        ("acceleration: A4_az}", "acceleration: A4_az, suspension_travel: A4_d}"),
        ("sensors:", "initial: {axle5: {displacement: 5 mm}}\nsensors:"),
    ],
)
def test_a_tandem_has_no_beam_whose_suspension_was_recorded_or_that_a_run_lifts(tmp_path, was, becomes):
    trials = trials_of_a_tandem(tmp_path, TANDEM_RUN.replace(was, becomes))
    assert EFFECTS["walking_beam"].places(trials[0].run.vehicle, trials) == ("axle2+axle3",)
