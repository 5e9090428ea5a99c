"""The commands: numbers against references typed here, the shape of their JSON and tables."""

from __future__ import annotations

import json
import re
from pathlib import Path

import jsonschema
import pytest

from tests.commands.calls import python, run_json
from vehgen.commands import main
from vehgen.mechanics.laws.schema import law_schema
from vehgen.simulate.run_file.schema import run_schema
from vehgen.vehicle import bundled_models
from vehgen.vehicle.schema import vehicle_schema


@pytest.mark.parametrize(
    ("arguments", "frequencies"),
    [
        # Wu & Li 2023, Table A2 row DHCM-1&2 and the truck of its Sect. 2.3; computed independently (shared/reference/wu_li_2023.json)
        (["tractor5"], [1.243784729, 2.710665116, 3.238006833, 11.99706999, 13.04757213, 16.65226161, 17.0339614, 19.55492624]),
        (
            ["tractor5.yaml", "--set", "DHCM-1-2"],
            [1.243784729, 2.710665116, 3.238006833, 11.99706999, 13.04757213, 16.65226161, 17.0339614, 19.55492624],
        ),
        (
            ["tractor5", "--set", "sensitivity"],
            [1.389324917, 1.693076712, 2.171124386, 8.850063006, 9.471814606, 9.510802528, 10.19188981, 10.22513606],
        ),
        # the same, laden with the module of Sect. 2.5: derived rightly, and in the paper's own form
        (
            ["tractor5_module"],
            [1.243297106, 2.627365595, 3.055570469, 6.787363978, 11.99764722, 13.05938722, 16.65229406, 17.03396126, 19.5549086],
        ),
        (
            ["tractor5_module_paper"],
            [1.243687316, 2.65621121, 3.041044072, 6.776455726, 11.99726986, 13.04656853, 16.65348226, 17.03397753, 19.55502271],
        ),
        # Wu & Li 2023, Table A1 row DHCM-F&R
        (["sedan2"], [1.311728997, 1.642946819, 10.76733726, 14.39470766]),
        # VBI-2D (github.com/DanielCanteroNTNU/VBI-2D, commit 1d36c83), run with its own matrices
        (["quarter_car"], [1.1112478077533552, 7.208241791310187]),
        (
            ["vbi2d_2A3"],
            [
                1.4105487359403277,
                1.5890769411084114,
                5.23507674698726,
                8.850827535858423,
                10.535306469414083,
                11.980748870304891,
                11.981741052332954,
                12.127094425523198,
            ],
        ),
    ],
    ids=lambda item: " ".join(map(str, item))[:25],
)
def test_undamped_frequencies(arguments: list[str], frequencies: list[float], capsys: pytest.CaptureFixture[str]):
    found = run_json(capsys, "modes", *arguments)
    assert set(found) == {"n_dof", "modes"}
    assert found["n_dof"] == len(frequencies)
    assert all(list(mode) == ["name", "undamped_hz", "damped_hz", "damping_ratio"] for mode in found["modes"])
    assert [mode["undamped_hz"] for mode in found["modes"]] == pytest.approx(frequencies, rel=2e-9)
    names = [mode["name"] for mode in found["modes"]]
    assert len(set(names)) == len(names)


@pytest.mark.parametrize(
    ("model", "poles"),
    [
        # real and imaginary part in rad/s, from VBI-2D's matrices (shared/reference/vbi2d_quarter_car.json, vbi2d_2A3.json)
        ("quarter_car", [(-0.24375390137480146, 6.97791976956781), (-10.25624609862521, 44.11415459565645)]),
        (
            "vbi2d_2A3",
            [
                (-0.09186568130782247, 8.863656140443794),
                (-0.11692261978972038, 9.983159657223776),
                (-0.939656613449734, 32.895642409314206),
                (-7.855124147495093, 55.04957806258967),
                (-4.934235739186953, 65.9974699352859),
                (-7.333333333333336, 74.91921575196105),
                (-7.333280525994486, 74.92540644301015),
                (-7.285576342069167, 75.82455709640772),
            ],
        ),
    ],
)
def test_damped_modes_are_the_poles(model: str, poles: list[tuple[float, float]], capsys: pytest.CaptureFixture[str]):
    modes = run_json(capsys, "modes", model)["modes"]
    found = sorted((mode["damped_hz"], mode["damping_ratio"]) for mode in modes)
    by_frequency = sorted(poles, key=lambda pole: pole[1])
    assert [hz for hz, _ in found] == pytest.approx([pole[1] / 6.283185307179586 for pole in by_frequency], rel=1e-9)
    assert [ratio for _, ratio in found] == pytest.approx([-pole[0] / abs(complex(*pole)) for pole in by_frequency], rel=1e-6)


def test_damped_modes_of_the_five_axles(capsys: pytest.CaptureFixture[str]):
    """Computed independently from the matrices of PHYSICS.md (shared/reference/wu_li_2023.json)."""
    modes = run_json(capsys, "modes", "tractor5")["modes"]
    found = sorted((mode["damped_hz"], mode["damping_ratio"]) for mode in modes)
    hertz = [1.263997626, 2.573690133, 3.410790653, 9.870128576, 10.89902868, 15.01405768, 16.59291948, 16.86657295]
    ratios = [0.1989466948, 0.3744152497, 0.2549615757, 0.5401819908, 0.4547455575, 0.4014041328, 0.07119782946, 0.4759854518]
    assert [hz for hz, _ in found] == pytest.approx(hertz, rel=2e-9)
    assert [ratio for _, ratio in found] == pytest.approx(ratios, rel=2e-8)


def test_static_loads_of_vbi2d(capsys: pytest.CaptureFixture[str]):
    """shared/reference/vbi2d_2A3.json; the hinge carries what of the semitrailer its own axles do not."""
    found = run_json(capsys, "static", "vbi2d_2A3")
    loads = [55162.20664017522, 105278.27884704091, 78252.47741669805, 77319.83817092795, 76387.19892515783]
    assert set(found) == {"axles", "hinges", "springs", "warnings"}
    assert list(found["axles"]) == ["axle1", "axle2", "axle3", "axle4", "axle5"]
    assert list(found["axles"].values()) == pytest.approx(loads, rel=1e-10)
    assert list(found["hinges"]) == ["fifth_wheel"]
    assert found["hinges"]["fifth_wheel"] == pytest.approx((31450 + 3 * 750) * 9.81 - sum(loads[2:]), rel=1e-9)
    assert any("radius of gyration of semitrailer" in warning for warning in found["warnings"])


def test_static_loads_of_the_quarter_car_and_the_sedan(capsys: pytest.CaptureFixture[str]):
    """107910 N: shared/reference/vbi2d_quarter_car.json; the sedan by the lever: Lf = 1.18 m, Lr = 1.62 m, unsprung 90 and 150 kg."""
    found = run_json(capsys, "static", "quarter_car")
    springs = {item.pop("kind"): item for item in found.pop("springs")}
    assert found == {"axles": {"axle1": pytest.approx(107910.0)}, "hinges": {}, "warnings": []}
    assert springs["suspension"] == {"name": "axle1", "force": pytest.approx(10000 * 9.81), "deflection": pytest.approx(98.1e3 / 1e6)}
    assert springs["tyre"] == {"name": "axle1", "force": pytest.approx(107910.0), "deflection": pytest.approx(107.91e3 / 1e6)}
    found = run_json(capsys, "static", "sedan2")
    front, rear = 1500 * 9.81 * 1.62 / 2.8 + 90 * 9.81, 1500 * 9.81 * 1.18 / 2.8 + 150 * 9.81
    assert found["axles"] == {"front": pytest.approx(front), "rear": pytest.approx(rear)}


@pytest.mark.parametrize("name", sorted(bundled_models()))
def test_axles_or_links_to_the_ground_carry_the_whole_weight_of_every_bundled_model(name: str, capsys: pytest.CaptureFixture[str]):
    from vehgen.mechanics import static_loads
    from vehgen.vehicle import load_vehicle

    vehicle = load_vehicle(name)
    values = vehicle.all_values(vehicle.values())
    masses = [body.mass for body in vehicle.bodies.values()] + [axle.mass for axle in vehicle.axles.values() if axle.mass is not None]
    weight = 9.81 * sum(mass.evaluate(values) for mass in masses) * vehicle.gravity
    grounded = [("link", link) for link, item in vehicle.links.items() if "ground" in item.points]
    held = sum(static_loads(vehicle).elements[key] for key in grounded)
    assert sum(run_json(capsys, "static", name)["axles"].values()) + held == pytest.approx(weight, rel=1e-9)


def test_a_set_changes_the_numbers(capsys: pytest.CaptureFixture[str]):
    plain, front = run_json(capsys, "modes", "sedan2"), run_json(capsys, "modes", "sedan2", "--set", "SHCM-F")
    assert plain != front
    assert run_json(capsys, "modes", "sedan2", "--set", "DHCM-F-R") == plain


def test_models(capsys: pytest.CaptureFixture[str]):
    found = run_json(capsys, "models")
    assert set(found) == {"models"}
    assert [item["name"] for item in found["models"]] == sorted(bundled_models())
    assert all(list(item) == ["name", "title", "sets", "source"] for item in found["models"])
    assert all(item["title"] and item["source"] for item in found["models"])
    assert {item["name"]: item["sets"] for item in found["models"]}["tractor5"] == ["SHCM-1", "SHCM-2", "DHCM-1-2", "sensitivity"]


def test_schema(capsys: pytest.CaptureFixture[str]):
    found = run_json(capsys, "schema")
    jsonschema.Draft202012Validator.check_schema(found)
    assert found == vehicle_schema(law_schema())
    run = run_json(capsys, "schema", "--run")
    jsonschema.Draft202012Validator.check_schema(run)
    assert run == run_schema()
    assert main(["schema"]) == 0
    assert json.loads(capsys.readouterr().out) == found


def test_tables_show_the_numbers(capsys: pytest.CaptureFixture[str]):
    assert main(["modes", "quarter_car"]) == 0
    table = capsys.readouterr().out
    assert re.search(r"body heave +1\.1112 ", table)
    assert re.search(r"axle1 hop +7\.2082 ", table)
    assert main(["static", "vbi2d_2A3"]) == 0
    table, told = capsys.readouterr()
    assert re.search(r"axle1 +55\.162 +14\.1%", table)
    assert re.search(r"all +392\.400", table)
    assert re.search(r"fifth_wheel +98\.637 +tractor carries semitrailer", table)
    assert told.startswith("warning: radius of gyration of semitrailer out of scale")
    assert told.count("\n") == told.count("warning: ")
    assert main(["models"]) == 0
    table = capsys.readouterr().out
    assert all(name in table for name in bundled_models())


def test_static_of_a_vehicle_without_springs_has_no_empty_table(work: Path, capsys: pytest.CaptureFixture[str]):
    (work / "bar.yaml").write_text("name: bar\ngravity: false\nbodies: {bar: {mass: 10 kg, pitch_inertia: 2 kg m^2}}\n")
    assert main(["static", "bar.yaml"]) == 0
    assert capsys.readouterr().out == "bar: no axle, hinge or spring carries anything\n"
    assert run_json(capsys, "static", "bar.yaml")["springs"] == []


def test_modes_of_what_no_stiffness_holds_say_so(work: Path, capsys: pytest.CaptureFixture[str]):
    (work / "bar.yaml").write_text("name: bar\ngravity: false\nbodies: {bar: {mass: 10 kg, pitch_inertia: 2 kg m^2}}\n")
    assert main(["modes", "bar.yaml"]) == 0
    told = capsys.readouterr().err.splitlines()
    assert told == [
        f"warning: no linear stiffness holds bar {motion}: 0 Hz; a spring, a tyre or a link would" for motion in ("heave", "pitch")
    ]
    assert main(["modes", "quarter_car"]) == 0
    assert not capsys.readouterr().err


def test_a_title_is_no_markup(work: Path, capsys: pytest.CaptureFixture[str]):
    (work / "a.yaml").write_text("extends: quarter_car\nname: a\ntitle: '[/x] [bold]half[laden] car'\n")
    for command in ("modes", "static"):
        assert main([command, "a.yaml"]) == 0
        assert "[/x] [bold]half[laden] car" in capsys.readouterr().out


def test_a_title_in_another_script_prints_on_a_plain_terminal(work: Path):
    (work / "a.yaml").write_text("extends: quarter_car\nname: a\ntitle: 自動車\n", encoding="utf-8")
    found = python("-m", "vehgen", "modes", "a.yaml", folder=work, PYTHONIOENCODING="ascii")
    assert (found.returncode, found.stderr) == (0, "")
    assert "??? : natural modes".replace(" ", "", 1) in found.stdout


@pytest.mark.parametrize(("name", "told"), [("sedan2", False), ("stopped", True)])
def test_modes_say_that_force_laws_are_left_out(tmp_path, capsys, monkeypatch, name, told):
    monkeypatch.chdir(tmp_path)
    laws = "axles: {front: {suspension: {laws: [{bump_stop: {k: 200 kN/m, clearance: 0.19 m, from: unloaded}}]}}}"
    Path("stopped.yaml").write_text(f"extends: sedan2\nname: stopped\n{laws}\n", encoding="utf-8")
    assert main(["modes", "sedan2" if name == "sedan2" else "stopped.yaml"]) == 0
    assert ("the force laws of stopped are left out" in capsys.readouterr().err) == told
