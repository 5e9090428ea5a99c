"""Effects of one's own, from YAML."""

import json
import re
from pathlib import Path

import jsonschema
import numpy as np
import pytest

from vehgen.commands import main
from vehgen.effects import EFFECTS, EffectLocator, extended_library, load_effects
from vehgen.effects.entry import effects_schema
from vehgen.errors import InputError
from vehgen.files.document import read_text
from vehgen.mechanics import Place
from vehgen.mechanics.law_terms import RATE, TRAVEL, read_laws
from vehgen.mechanics.outputs import PointOutput
from vehgen.road import ConstantSpeed, Hump, Track
from vehgen.simulate import Scenario, Simulator
from vehgen.vehicle import load_vehicle
from vehgen.vehicle.loading import extend_vehicle

PAGE = Path(__file__).parents[2] / "docs" / "effects.md"
(EXAMPLE,) = re.findall(r"```yaml\n(.*?)```", PAGE.read_text(encoding="utf-8"), re.DOTALL)
SMALL = """effects:
  stiffer:
    title: A stiffer spring
    meaning: a spring
    attaches: suspension
    force: k3*d^3
    parameters:
      k3: {unit: N/m^3, low: 1e4, high: 1e9, starts: [1e7], meaning: cubic stiffness}
"""


@pytest.fixture
def file(tmp_path):
    path = tmp_path / "mine.yaml"
    path.write_text(EXAMPLE, encoding="utf-8")
    return path


@pytest.fixture(scope="module")
def site():
    vehicle = load_vehicle("sedan2")
    return EffectLocator(vehicle, vehicle.values()).site("rear")


def test_the_pages_example_is_two_effects_of_a_vehicle(file, site):
    effects = load_effects(file)
    assert list(effects) == ["soft_damper", "symmetric_stop"]
    damper, stop = effects.values()
    assert damper.equation == "f = c3*v^3 + k3*d^3"
    assert damper.places(site.vehicle, ()) == ("front", "rear")
    c3, k3 = damper.parameters
    assert c3.bounds(site) == pytest.approx((0.01 * site.c / 0.01, 100 * site.c / 0.01))
    assert k3.first(site) == (1e7,)
    assert (k3.unit, stop.parameters[1].unit) == ("N/m^3", "m")
    assert stop.parameters[1].bounds(site) == pytest.approx((1e-3, 0.06))


def test_its_force_is_what_the_entry_says(file, site):
    effect = load_effects(file)["soft_damper"]
    vehicle = extend_vehicle(site.vehicle, effect.change(site, {"c3": 2e4, "k3": 3e7}))
    (term,) = read_laws(vehicle, "suspension", "rear")
    symbols = effect.symbols("rear")
    values = {symbols["c3"]: 2e4, symbols["k3"]: 3e7, TRAVEL.name: 0.02, RATE.name: -0.3}
    found = term.step().now
    number = found.subs({item: values[item.name] for item in found.free_symbols})
    assert float(number) == pytest.approx(2e4 * -0.027 + 3e7 * 8e-6)
    assert set(symbols.values()) <= set(vehicle.ranges())


def test_a_law_of_the_library_takes_numbers_and_expressions(file, site):
    vehicle = extend_vehicle(site.vehicle, load_effects(file)["symmetric_stop"].change(site, {"k": 1e5, "gap": 0.01}))
    (term,) = read_laws(vehicle, "suspension", "rear")
    values = vehicle.values()
    numbers = {key: float(item.subs({name: values[name.name] for name in item.free_symbols})) for key, item in term.parameters.items()}
    assert numbers == pytest.approx({"k": 2e5, "clearance": 0.01, "rebound": 0.01})


def test_an_entry_simulates_as_the_library_does(tmp_path, site):
    (tmp_path / "a.yaml").write_text(SMALL, encoding="utf-8")
    own, known = load_effects(tmp_path / "a.yaml")["stiffer"], EFFECTS["cubic_stiffness"]
    track = Track((Hump.from_shape("half_sine", 1.0, 0.5, 0.04),))
    answers = []
    for effect in (own, known):
        vehicle = extend_vehicle(site.vehicle, effect.change(site, {"k3": 1e8}))
        simulator = Simulator(vehicle, [PointOutput("az", Place("rear", "body", behind="rear"), "acceleration")])
        answers.append(simulator.run(simulator.parameters(), Scenario(track, ConstantSpeed(2.0), 4.0, 1e-3, 10)).responses[0, :, 0])
    assert np.abs(answers[0]).max() > 1
    assert answers[0] == pytest.approx(answers[1], abs=1e-6)


def test_hinges_and_tyres_carry_entries_too(tmp_path):
    text = """effects:
  turn: {title: A, meaning: b, attaches: hinge, law: {dry_friction: {force: F}},
         parameters: {F: {unit: N m, low: 0.1, high: 9, starts: [1], times: 0.1 m * load, meaning: moment}}}
  squash: {title: A, meaning: b, attaches: tyre, force: "k2 * d * abs(d)",
           parameters: {k2: {unit: kN/m^2, low: 1, high: 900, starts: [100], meaning: hardening}}}
"""
    (tmp_path / "a.yaml").write_text(text, encoding="utf-8")
    vehicle = load_vehicle("tractor5")
    surveyor = EffectLocator(vehicle, vehicle.values())
    for effect in load_effects(tmp_path / "a.yaml").values():
        place = effect.places(vehicle, ())[0]
        changed = extend_vehicle(vehicle, effect.change(surveyor.site(place)))
        assert len(read_laws(changed, effect.attaches, place)) == 1
    assert effect.parameters[0].first(surveyor.site("axle1")) == (1e5,)
    assert effect.parameters[0].unit == "kg m^-1 s^-2"


@pytest.mark.parametrize(
    ("old", "new", "place", "message"),
    [
        ("force: k3*d^3", "law: {cubic_stifness: {k3: k3}}", "6:11", "did you mean 'cubic_stiffness'"),
        ("force: k3*d^3", "law: {cubic_stiffness: {}}", "6:11", "lacks its parameter 'k3'"),
        ("force: k3*d^3", "law: {cubic_stiffness: {k3: k3, k4: k3}}", "6:37", "has no parameter 'k4'"),
        ("force: k3*d^3", "law: {cubic_stiffness: {k3: 5 N}}", "6:33", "k3 must be in kg m^-2 s^-2, found N"),
        ("force: k3*d^3", "law: {tyre_liftoff: {share: 1}}", "6:11", "belongs on a tyre, not on a suspension"),
        ("force: k3*d^3", "law: {law: {force: k3*d^3}}", "6:11", "under `force`"),
        ("force: k3*d^3", "law: {cubic_stiffness: {k3: k3}}\n    force: k3*d^3", "2:3", "either `law`"),
        ("    force: k3*d^3\n", "", "2:3", "either `law`"),
        ("force: k3*d^3", "force: k4*d^3", "6:12", "unknown symbol 'k4'; known: d, k3, v"),
        ("force: k3*d^3", "force: k3*d^2", "6:12", "force must be in N, found"),
        ("force: k3*d^3", "force: 1 kN/m * d", "8:7", "'k3' is used nowhere"),
        ("force: k3*d^3", "force: __import__('os')", "6:12", "underscore"),
        ("  stiffer:", "  dry_friction:", "2:3", "named 'dry_friction' already"),
        ("  stiffer:", "  my spring:", "2:3", "'my spring' cannot be a name"),
        ("      k3: {", "      v: {", "8:7", "travel or rate"),
        ("unit: N/m^3", "unit: N/parsec^3", "8:18", "unknown unit"),
        ("low: 1e4", "low: 1e10", "8:30", "`low` must be below `high`"),
        ("starts: [1e7]", "starts: [1e7, 2]", "8:60", "a start must lie within"),
        ("starts: [1e7]", "starts: []", "8:54", "at least 1 item"),
        ("high: 1e9", "high: .inf", "8:41", "finite number"),
        ("meaning: cubic", "times: load, meaning: cubic", "8:68", "times must be in kg m^-2 s^-2, found N"),
        ("meaning: cubic", "times: weight, meaning: cubic", "8:68", "unknown symbol 'weight'"),
        ("attaches: suspension", "attaches: axle", "5:15", "'suspension', 'tyre' or 'hinge'"),
        ("title: A stiffer spring", "titel: A stiffer spring", "3:5", "did you mean 'title'"),
        ("    meaning: a spring\n", "", "2:3", "lacks the key 'meaning'"),
    ],
)
def test_a_bad_entry_is_refused_at_its_place(tmp_path, old, new, place, message):
    assert old in SMALL
    path = tmp_path / "bad.yaml"
    path.write_text(SMALL.replace(old, new, 1), encoding="utf-8")
    with pytest.raises(InputError, match=re.escape(message)) as caught:
        load_effects(path)
    assert str(caught.value.position) == f"{path}:{place}"


def test_two_files_may_not_share_a_name(tmp_path, file):
    assert list(extended_library([file]))[-2:] == ["soft_damper", "symmetric_stop"]
    with pytest.raises(InputError, match="'soft_damper' already"):
        extended_library([file, file])


def test_the_command_lists_them(file, capsys):
    assert main(["effects", "--library", str(file), "--json"]) == 0
    listed = json.loads(capsys.readouterr().out)
    assert listed[-2]["name"] == "soft_damper"
    assert listed[-2]["parameters"][0] == {"name": "c3", "unit": "N s^3/m^3", "meaning": "cubic damping"}
    assert main(["effects", "--library", "missing.yaml"]) == 2
    assert "no file missing.yaml" in capsys.readouterr().err


def test_the_schema_knows_the_example_and_refuses_other_keys(capsys):
    assert main(["schema", "--effects"]) == 0
    schema = json.loads(capsys.readouterr().out)
    assert schema == effects_schema()
    check = jsonschema.Draft202012Validator(schema)
    data = read_text(EXAMPLE, "docs").plain()
    check.validate(data)
    data["effects"]["soft_damper"]["parameters"]["c3"]["lowest"] = 1
    assert not check.is_valid(data)
