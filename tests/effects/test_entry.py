"""Effects of one's own, from YAML."""

import json
import re
from pathlib import Path

import jsonschema
import numpy as np
import pytest

from vehgen.commands import main
from vehgen.effects import EFFECTS, EffectLocator, effects, load_effects
from vehgen.effects.entry import effects_schema
from vehgen.errors import InputError
from vehgen.files.document import read_text
from vehgen.mechanics import Place, derive
from vehgen.mechanics.law_terms import RATE, TRAVEL, read_laws
from vehgen.mechanics.outputs import PointOutput
from vehgen.road import ConstantSpeed, Hump, Track
from vehgen.simulate import Scenario, Simulator
from vehgen.vehicle import load_vehicle

PAGE = Path(__file__).parents[2] / "docs" / "effects.md"
(EXAMPLE,) = re.findall(r"```yaml\n(.*?)```", PAGE.read_text(encoding="utf-8"), re.DOTALL)
(PACKAGE,) = re.findall(r"```python\n(.*?)```", PAGE.read_text(encoding="utf-8"), re.DOTALL)
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


def test_the_pages_example_begins_with_two_laws_of_a_suspension(file, site):
    effects = load_effects(file)
    assert list(effects) == ["soft_damper", "symmetric_stop", "stiff_carcass", "late_phone", "cooling_fan"]
    damper, stop, *_ = effects.values()
    assert damper.equation == "f = c3*v^3 + k3*d^3"
    assert damper.places(site.vehicle, ()) == ("front", "rear", "all suspensions")
    c3, k3 = damper.parameters
    assert c3.bounds(site) == pytest.approx((0.01 * site.c / 0.01, 100 * site.c / 0.01))
    assert k3.first(site) == (1e7,)
    assert (k3.unit, stop.parameters[1].unit) == ("N/m^3", "m")
    assert stop.parameters[1].bounds(site) == pytest.approx((1e-3, 0.06))


def test_its_force_is_what_the_entry_says(file, site):
    effect = load_effects(file)["soft_damper"]
    vehicle = site.vehicle.with_changes(effect.change(site, {"c3": 2e4, "k3": 3e7}))
    (term,) = read_laws(vehicle, "suspension", "rear")
    symbols = effect.symbols("rear")
    values = {symbols["c3"]: 2e4, symbols["k3"]: 3e7, TRAVEL.name: 0.02, RATE.name: -0.3}
    found = term.step().now
    number = found.subs({item: values[item.name] for item in found.free_symbols})
    assert float(number) == pytest.approx(2e4 * -0.027 + 3e7 * 8e-6)
    assert set(symbols.values()) <= set(vehicle.ranges())


def test_a_law_of_the_library_takes_numbers_and_expressions(file, site):
    vehicle = site.vehicle.with_changes(load_effects(file)["symmetric_stop"].change(site, {"k": 1e5, "gap": 0.01}))
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
        vehicle = site.vehicle.with_changes(effect.change(site, {"k3": 1e8}))
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
    locator = EffectLocator(vehicle, vehicle.values())
    for effect in load_effects(tmp_path / "a.yaml").values():
        place = effect.places(vehicle, ())[0]
        changed = vehicle.with_changes(effect.change(locator.site(place)))
        assert len(read_laws(changed, effect.attaches, place)) == 1
    assert effect.parameters[0].first(locator.site("axle1")) == (1e5,)
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


RUN = """effects:
  late:
    title: Late
    meaning: a clock
    adjusts: delay
    parameters:
      by: {unit: ms, low: -20, high: 90, starts: [10, 30], meaning: late}
"""
LINE = """effects:
  fan:
    title: Fan
    meaning: a fan
    line: {low: 8 Hz, high: 30 Hz}
"""


def test_an_entry_of_a_global_law_on_tyres_reaches_all_of_them(file):
    vehicle = load_vehicle("tractor5")
    effect, locator = load_effects(file)["stiff_carcass"], EffectLocator(vehicle, vehicle.values())
    assert effect.is_global
    assert effect.places(vehicle, ()) == ("all tyres", *vehicle.axles)
    (every,), (first,) = (effect.search_dimensions(place, locator) for place in ("all tyres", "axle1"))
    mean = sum(locator.site(axle).kt for axle in vehicle.axles) / 5
    assert every.high / first.high == pytest.approx(mean / locator.site("axle1").kt)
    changed = vehicle.with_changes(effect.change(locator.site("all tyres")))
    assert all(len(read_laws(changed, "tyre", axle)) == len(read_laws(vehicle, "tyre", axle)) + 1 for axle in vehicle.axles)


def test_an_entry_of_runs_takes_the_quantity_of_the_library_in_its_own_unit_and_range(tmp_path):
    (tmp_path / "a.yaml").write_text(RUN, encoding="utf-8")
    effect = load_effects(tmp_path / "a.yaml")["late"]
    (parameter,) = effect.parameters
    assert (parameter.unit, parameter.low, parameter.high) == ("s", pytest.approx(-0.02), pytest.approx(0.09))
    assert parameter.starts == pytest.approx((0.01, 0.03))
    (own,), (known,) = effect.adjustments("F", {}), EFFECTS["sensor_delay"].adjustments("F", {})
    assert type(own) is type(known)
    assert (own.scale, own.neutral) == (known.scale, known.neutral)
    assert (own.low, own.high) == pytest.approx((-0.02, 0.09))
    assert effect.n_numbers(4) == 1
    assert not effect.changes_vehicle


@pytest.mark.parametrize("told", ["", "    global: true\n", "    global: false\n"])
@pytest.mark.parametrize(("quantity", "known"), [("speed", "speed_error"), ("gain", "sensor_gain"), ("position", "sensor_position")])
def test_an_entry_says_whether_it_is_global_or_the_library_does(tmp_path, told, quantity, known):
    text = RUN.replace("delay", quantity).replace("unit: ms, low: -20, high: 90, starts: [10, 30]", "low: 0.5, high: 2, starts: [1]")
    text = text.replace("low: 0.5", "unit: m, low: 0.5") if quantity == "position" else text
    (tmp_path / "a.yaml").write_text(text.replace("    parameters", f"{told}    parameters"), encoding="utf-8")
    assert load_effects(tmp_path / "a.yaml")["late"].is_global == ("true" in told if told else EFFECTS[known].is_global)


def test_an_entry_of_a_line_is_looked_for_between_its_frequencies(tmp_path):
    (tmp_path / "a.yaml").write_text(LINE, encoding="utf-8")
    effect = load_effects(tmp_path / "a.yaml")["fan"]
    vehicle = load_vehicle("tractor5")
    assert effect.looked_for == pytest.approx((8.0, 30.0))
    line, _ = effect.adjustments("tractor", {})
    assert (line.low, line.high) == pytest.approx((8.0, 30.0))
    assert effect.places(vehicle, ()) == ("tractor", "semitrailer")
    assert effect.n_numbers(3) == 2 + 3 * 4
    assert [item.name for item in effect.solved_parameters] == ["amplitude"]


@pytest.mark.parametrize(
    ("text", "old", "new", "place", "message"),
    [
        (RUN, "adjusts: delay", "adjusts: dely", "5:14", "'speed', 'footprint', 'gain', 'delay', 'tilt' or 'position'"),
        (RUN, "    adjusts: delay\n", "", "2:3", "found none of them"),
        (RUN, "    adjusts: delay", "    line: {low: 1 Hz, high: 2 Hz}\n    adjusts: delay", "2:3", "found adjusts and line"),
        (RUN, "    adjusts: delay", "    adjusts: delay\n    attaches: hinge", "6:5", "leave `attaches` out"),
        (RUN, "    adjusts: delay\n", "    force: by*d\n", "2:3", "lacks the key 'attaches'"),
        (RUN, "unit: ms", "unit: mm", "7:18", "delay is in s or a unit like it, found mm"),
        (RUN, "unit: ms, ", "", "7:7", "delay is in s or a unit like it, found no unit"),
        (RUN, "adjusts: delay", "adjusts: gain", "7:18", "gain is a plain number, found ms"),
        (RUN, "starts: [10, 30]", "starts: [10, 300]", "7:55", "a start must lie within"),
        (RUN, "meaning: late}", "meaning: late, times: load}", "7:75", "leave `times` out"),
        (
            RUN,
            "    parameters:\n      by: {unit: ms, low: -20, high: 90, starts: [10, 30], meaning: late}\n",
            "",
            "5:14",
            "one parameter, found 0",
        ),
        (RUN, "late}\n", "late}\n      to: {low: 0, high: 1, starts: [0], meaning: b}\n", "5:14", "one parameter, found 2"),
        (RUN.replace("delay", "speed"), "unit: ms, low: -20", "low: 0", "7:17", "speed is above 0"),
        (RUN, "adjusts: delay", "adjusts: delay\n    global: perhaps", "6:13", "valid boolean"),
        (LINE, "low: 8 Hz", "low: 8 m", "5:17", "low must be in 1/s, found m"),
        (LINE, "low: 8 Hz", "low: f1", "5:17", "unknown symbol 'f1'"),
        (LINE, "low: 8 Hz", "low: 80 Hz", "5:17", "below `high`, found 80 and 30 Hz"),
        (LINE, "low: 8 Hz", "low: 0 Hz", "5:17", "above 0"),
        (LINE, "low: 8 Hz, ", "", "5:5", "lacks the key 'low'"),
        (LINE, "    line", "    attaches: hinge\n    line", "5:5", "leave `attaches` out"),
        (LINE, "    line", "    parameters: {a: {low: 0, high: 1, starts: [0], meaning: b}}\n    line", "5:18", "no parameters of its own"),
    ],
)
def test_a_bad_entry_of_runs_or_a_line_is_refused_at_its_place(tmp_path, text, old, new, place, message):
    assert old in text
    path = tmp_path / "bad.yaml"
    path.write_text(text.replace(old, new, 1), encoding="utf-8")
    with pytest.raises(InputError, match=re.escape(message)) as caught:
        load_effects(path)
    assert str(caught.value.position) == f"{path}:{place}"


def test_the_pages_python_is_an_effect_that_damps_a_hinge():
    made = {}
    exec(compile(PACKAGE, str(PAGE), "exec"), made)
    effect, vehicle = made["HINGE_DAMPING"], load_vehicle("tractor5")
    (place,) = effect.places(vehicle, ())
    changed = vehicle.with_changes(effect.change(EffectLocator(vehicle, vehicle.values()).site(place), {"c": 5e4}))
    before, after = derive(vehicle).numeric(), derive(changed).numeric()
    pitch = [i for i, item in enumerate(derive(vehicle).coordinates) if item.name in ("pitch.tractor", "pitch.semitrailer")]
    assert np.linalg.eigvalsh((after.C - before.C)[np.ix_(pitch, pitch)]) == pytest.approx([0, 1e5], abs=1e-6)


def test_two_files_may_not_share_a_name(tmp_path, file):
    assert list(effects([file]))[-2:] == ["late_phone", "cooling_fan"]
    with pytest.raises(InputError, match="'soft_damper' already"):
        effects([file, file])


def test_the_command_lists_them(file, capsys):
    assert main(["effects", "--library", str(file), "--json"]) == 0
    listed = json.loads(capsys.readouterr().out)
    assert [item["name"] for item in listed if item["is_global"]][-1] == "stiff_carcass"
    assert listed[-5]["name"] == "soft_damper"
    assert listed[-5]["parameters"][0] == {
        "name": "c3",
        "unit": "N s^3/m^3",
        "searched": "0.01 to 100 times c/(0.1 m/s)^2",
        "meaning": "cubic damping",
    }
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
