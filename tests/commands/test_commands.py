"""The commands: numbers against references typed here, the shape of their JSON, faults, help, and what they import."""

from __future__ import annotations

import json
import os
import re
import shlex
import subprocess
import sys
import warnings
from collections.abc import Callable
from pathlib import Path
from typing import Any

import jsonschema
import pytest

import vehgen
from vehgen.commands import COMMANDS, main, make_parser
from vehgen.errors import ModelWarning
from vehgen.simulate.runfile import RunFile
from vehgen.vehicle import bundled_models
from vehgen.vehicle.schema import vehicle_schema

NAMES = [getattr(command, "NAME", command.__name__.rpartition(".")[2]) for command in COMMANDS]
HEAVY = {"sympy", "numba", "numpy", "scipy", "matplotlib", "rich", "pydantic", "ruamel"}

BAD_VEHICLES = {
    "unknown key": ("bodies:\n  body: {mas: 1 kg}\n", "2:10: unknown key 'mas'; did you mean 'mass'?"),
    "missing unit": ("bodies:\n  body: {mass: 1000, motions: [heave]}\n", "2:16: missing unit: bodies.body.mass must be in kg"),
    "call": ("bodies:\n  body: {mass: 'open(1) * 1 kg', motions: [heave]}\n", "2:17: only sqrt, abs, sign, min, max may be called"),
    "YAML": ("bodies: {a: [}\n", "1:14: not valid YAML"),
    "tag": (
        "bodies: !!python/object/apply:os.mkdir [hacked]\n",
        "1:9: the tag tag:yaml.org,2002:python/object/apply:os.mkdir is not allowed",
    ),
    "empty": ("", "1:1: the file is empty"),
    "circle": ("name: a\nextends: bad.yaml\n", "2:10: circular `extends`: bad.yaml -> bad.yaml"),
    "folder": ("name: ../../up\nextends: quarter_car\n", "1:7: '../../up' cannot name a vehicle"),
}


def run_json(capsys: pytest.CaptureFixture[str], *arguments: str) -> Any:
    """Run a command with --json in this process; return what it printed."""
    assert main([*arguments, "--json"]) == 0
    captured = capsys.readouterr()
    assert captured.err == ""
    return json.loads(captured.out)


def python(*arguments: str, folder: Path | None = None, **environment: str) -> subprocess.CompletedProcess[str]:
    """Run `python ...` in a new process."""
    source = str(Path(vehgen.__file__).parents[1])
    path = os.pathsep.join([source, os.environ.get("PYTHONPATH", "")])
    return subprocess.run(
        [sys.executable, *arguments],
        capture_output=True,
        text=True,
        encoding="utf-8",
        cwd=folder,
        env={**os.environ, "PYTHONPATH": path, **environment},
        check=False,
    )


@pytest.fixture
def work(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """An empty working folder."""
    monkeypatch.chdir(tmp_path)
    return tmp_path


# --- numbers


@pytest.mark.parametrize(
    ("arguments", "frequencies"),
    [
        # Wu & Li 2023, Table A2 row DHCM-1&2 and the truck of its Sect. 2.3; computed independently (shared/reference/wu_li_2023.json)
        (["tractor5"], [1.243784729, 2.710665116, 3.238006833, 11.99706999, 13.04757213, 16.65226161, 17.0339614, 19.55492624]),
        (
            ["tractor5.yaml", "--set", "DHCM-1&2"],
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
    """`damped_hz` is |pole|/2 pi, so that pole = 2 pi damped_hz (-zeta +- i sqrt(1 - zeta^2))."""
    modes = run_json(capsys, "modes", model)["modes"]
    found = sorted((mode["damped_hz"], mode["damping_ratio"]) for mode in modes)
    radii = sorted(abs(complex(*pole)) for pole in poles)
    by_radius = sorted(poles, key=lambda pole: abs(complex(*pole)))
    assert [hz for hz, _ in found] == pytest.approx([radius / 6.283185307179586 for radius in radii], rel=1e-9)
    assert [ratio for _, ratio in found] == pytest.approx([-pole[0] / abs(complex(*pole)) for pole in by_radius], rel=1e-6)


def test_damped_modes_of_the_five_axles(capsys: pytest.CaptureFixture[str]):
    """Computed independently from the matrices of PHYSICS.md (shared/reference/wu_li_2023.json), ascending in |pole|."""
    modes = run_json(capsys, "modes", "tractor5")["modes"]
    found = sorted((mode["damped_hz"], mode["damping_ratio"]) for mode in modes)
    hertz = [1.289779923, 2.775582868, 3.527365915, 11.72853589, 12.23755536, 16.39266357, 16.63513589, 19.17847799]
    ratios = [0.1989466948, 0.3744152497, 0.2549615757, 0.5401819908, 0.4547455575, 0.4014041328, 0.07119782946, 0.4759854518]
    assert [hz for hz, _ in found] == pytest.approx(hertz, rel=2e-9)
    assert [ratio for _, ratio in found] == pytest.approx(ratios, rel=2e-8)


def test_static_loads_of_vbi2d(capsys: pytest.CaptureFixture[str]):
    """shared/reference/vbi2d_2A3.json; the hinge carries what of the semitrailer its own axles do not."""
    found = run_json(capsys, "static", "vbi2d_2A3")
    loads = [55162.20664017522, 105278.27884704091, 78252.47741669805, 77319.83817092795, 76387.19892515783]
    assert set(found) == {"axles", "hinges", "warnings"}
    assert list(found["axles"]) == ["axle1", "axle2", "axle3", "axle4", "axle5"]
    assert list(found["axles"].values()) == pytest.approx(loads, rel=1e-10)
    assert list(found["hinges"]) == ["fifth_wheel"]
    assert found["hinges"]["fifth_wheel"] == pytest.approx((31450 + 3 * 750) * 9.81 - sum(loads[2:]), rel=1e-9)
    assert any("radius of gyration of semitrailer" in warning for warning in found["warnings"])


def test_static_loads_of_the_quarter_car_and_the_sedan(capsys: pytest.CaptureFixture[str]):
    """107910 N: shared/reference/vbi2d_quarter_car.json; the sedan by the lever: Lf = 1.18 m, Lr = 1.62 m, unsprung 90 and 150 kg."""
    assert run_json(capsys, "static", "quarter_car") == {"axles": {"axle1": pytest.approx(107910.0)}, "hinges": {}, "warnings": []}
    found = run_json(capsys, "static", "sedan2")
    front, rear = 1500 * 9.81 * 1.62 / 2.8 + 90 * 9.81, 1500 * 9.81 * 1.18 / 2.8 + 150 * 9.81
    assert found["axles"] == {"front": pytest.approx(front), "rear": pytest.approx(rear)}


@pytest.mark.parametrize("name", sorted(bundled_models()))
def test_axles_carry_the_whole_weight_of_every_bundled_model(name: str, capsys: pytest.CaptureFixture[str]):
    from vehgen.vehicle import load_vehicle

    vehicle = load_vehicle(name)
    values = vehicle.all_values(vehicle.values())
    masses = [body.mass for body in vehicle.bodies.values()] + [axle.mass for axle in vehicle.axles.values() if axle.mass is not None]
    weight = 9.81 * sum(mass.evaluate(values) for mass in masses)
    assert sum(run_json(capsys, "static", name)["axles"].values()) == pytest.approx(weight, rel=1e-9)


def test_a_set_changes_the_numbers(capsys: pytest.CaptureFixture[str]):
    plain, front = run_json(capsys, "modes", "sedan2"), run_json(capsys, "modes", "sedan2", "--set", "SHCM-F")
    assert plain != front
    assert run_json(capsys, "modes", "sedan2", "--set", "DHCM-F&R") == plain


# --- lists and schemas


def test_models(capsys: pytest.CaptureFixture[str]):
    found = run_json(capsys, "models")
    assert set(found) == {"models"}
    assert [item["name"] for item in found["models"]] == sorted(bundled_models())
    assert all(list(item) == ["name", "title", "sets", "source"] for item in found["models"])
    assert all(item["title"] and item["source"] for item in found["models"])
    assert {item["name"]: item["sets"] for item in found["models"]}["tractor5"] == ["SHCM-1", "SHCM-2", "DHCM-1&2", "sensitivity"]


def test_schema(capsys: pytest.CaptureFixture[str]):
    found = run_json(capsys, "schema")
    jsonschema.Draft202012Validator.check_schema(found)
    assert found == vehicle_schema()
    run = run_json(capsys, "schema", "--run")
    jsonschema.Draft202012Validator.check_schema(run)
    assert run == {"$schema": "https://json-schema.org/draft/2020-12/schema", **RunFile.model_json_schema()}
    assert main(["schema"]) == 0
    assert json.loads(capsys.readouterr().out) == found


# --- tables


def test_tables_show_the_numbers(capsys: pytest.CaptureFixture[str]):
    assert main(["modes", "quarter_car"]) == 0
    table = capsys.readouterr().out
    assert re.search(r"body heave +1\.1112 ", table)
    assert re.search(r"axle1 hop +7\.2082 ", table)
    assert main(["static", "vbi2d_2A3"]) == 0
    table = capsys.readouterr().out
    assert re.search(r"axle1 +55,162\.2 +14\.1%", table)
    assert re.search(r"all +392,400\.0", table)
    assert re.search(r"fifth_wheel +98,637\.5 +tractor carries semitrailer", table)
    assert "warning: radius of gyration of semitrailer out of scale" in " ".join(table.split())
    assert main(["models"]) == 0
    table = capsys.readouterr().out
    assert all(name in table for name in bundled_models())


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


# --- faults


@pytest.mark.parametrize("command", ["modes", "static", "build"])
@pytest.mark.parametrize("fault", sorted(BAD_VEHICLES))
def test_a_bad_vehicle_is_one_line_on_stderr(command: str, fault: str, work: Path, capsys: pytest.CaptureFixture[str]):
    text, message = BAD_VEHICLES[fault]
    (work / "bad.yaml").write_text(text)
    for extra in ([], ["--json"]):
        assert main([command, "bad.yaml", *extra]) == 2
        captured = capsys.readouterr()
        assert captured.out == ""
        assert captured.err.startswith(f"error: bad.yaml:{message}")
        assert captured.err.count("\n") == 1
    assert [path.name for path in work.iterdir()] == ["bad.yaml"]


@pytest.mark.parametrize("fault", sorted(BAD_VEHICLES))
def test_a_bad_vehicle_of_a_run_is_one_line_on_stderr(fault: str, work: Path, capsys: pytest.CaptureFixture[str]):
    text, message = BAD_VEHICLES[fault]
    (work / "bad.yaml").write_text(text)
    (work / "run.yaml").write_text("vehicle: bad.yaml\nspeed: 1 m/s\nduration: 1 s\n")
    assert main(["simulate", "run.yaml"]) == 2
    captured = capsys.readouterr()
    assert captured.out == ""
    assert captured.err.startswith(f"error: bad.yaml:{message}")
    assert captured.err.count("\n") == 1
    assert sorted(path.name for path in work.iterdir()) == ["bad.yaml", "run.yaml"]


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("vehicle: quarter_car\nsped: 1 m/s\n", "run.yaml:2:1: unknown key 'sped'; did you mean 'speed' or 'sample'?"),
        ("vehicle: quarter_car\nspeed: 1 kg\nduration: 1 s\n", "run.yaml:2:8: expected m/s, found kg in '1 kg'"),
        ("vehicle: quarter_car\nspeed: 1 m/s\n", "run.yaml:1:1: a run without a hump needs `duration`, e.g. 10 s"),
        (
            "vehicle: quarter_car\nspeed: 1 m/s\nset: a\nduration: 1 s\n",
            "run.yaml:3:6: quarter_car has no parameter set 'a'; none is declared",
        ),
        (
            "vehicle: quarter_car\nspeed: 1 m/s\nduration: 1 s\nroad:\n  - profile: {file: absent.csv}\n",
            "run.yaml:5:3: no file absent.csv",
        ),
        ("vehicle: quarter_car\nspeed: {file: absent.csv}\nduration: 1 s\n", "run.yaml:2:15: no file absent.csv"),
    ],
)
def test_a_bad_run_is_one_line_on_stderr(text: str, message: str, work: Path, capsys: pytest.CaptureFixture[str]):
    (work / "run.yaml").write_text(text)
    assert main(["simulate", "run.yaml", "--json"]) == 2
    captured = capsys.readouterr()
    assert captured.out == ""
    assert captured.err == f"error: {message}\n"
    assert [path.name for path in work.iterdir()] == ["run.yaml"]


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["modes", "tractr5"], "error: no file tractr5, and no bundled model 'tractr5'; did you mean 'tractor5' or 'tractor5_cab' or"),
        (["modes", "."], "error: . is a folder; a YAML file was expected"),
        (["modes", "tractor5", "--set", "SHCM1"], "error: tractor5 has no parameter set 'SHCM1'; did you mean 'SHCM-1'"),
        (["simulate", "absent.yaml"], "error: no file absent.yaml"),
        (["static", "floating.yaml"], "error: singular stiffness: nothing holds heave.body against gravity"),
    ],
)
def test_other_faults(arguments: list[str], message: str, work: Path, capsys: pytest.CaptureFixture[str]):
    (work / "floating.yaml").write_text("bodies:\n  body: {mass: 1 kg, motions: [heave]}\n")
    assert main(arguments) == 2
    captured = capsys.readouterr()
    assert captured.out == ""
    assert captured.err.startswith(message)
    assert captured.err.count("\n") == 1


@pytest.mark.parametrize("command", ["modes", "build"])
def test_a_fault_in_a_process_of_its_own(command: str, work: Path):
    (work / "bad.yaml").write_text(BAD_VEHICLES["tag"][0])
    found = python("-m", "vehgen", command, "bad.yaml", folder=work)
    assert found.returncode == 2
    assert found.stdout == ""
    assert found.stderr == f"error: bad.yaml:{BAD_VEHICLES['tag'][1]}\n"
    assert [path.name for path in work.iterdir()] == ["bad.yaml"]


@pytest.mark.parametrize("arguments", [["modes"], ["mods", "tractor5"], ["modes", "tractor5", "--sett", "a"], ["models", "tractor5"]])
def test_wrong_arguments(arguments: list[str], capsys: pytest.CaptureFixture[str]):
    with pytest.raises(SystemExit) as left:
        main(arguments)
    assert left.value.code == 2
    captured = capsys.readouterr()
    assert captured.out == ""
    assert captured.err.startswith("usage: python -m vehgen")


def raising(error: BaseException) -> Callable[..., None]:
    def run(options: object) -> None:
        raise error

    return run


def test_stopping_and_a_closed_pipe(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]):
    monkeypatch.setattr("vehgen.commands.models.run", raising(KeyboardInterrupt()))
    assert main(["models"]) == 130
    assert capsys.readouterr().err == "stopped\n"
    found = subprocess.run(
        f"{shlex.quote(sys.executable)} -m vehgen schema | head -1", shell=True, capture_output=True, text=True, check=True
    )
    assert (found.stdout, found.stderr) == ("{\n", "")


def test_doubts_are_warnings_on_stderr(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]):
    def run(options: object) -> None:
        warnings.warn(ModelWarning("the step is coarse"), stacklevel=2)
        warnings.warn(ModelWarning("the step is coarse"), stacklevel=2)

    monkeypatch.setattr("vehgen.commands.models.run", run)
    assert main(["models"]) == 0
    captured = capsys.readouterr()
    assert captured.err == "warning: the step is coarse\n" * 2
    assert captured.out == ""


def test_a_defect_is_not_hidden(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr("vehgen.commands.models.run", raising(RuntimeError("a defect")))
    with pytest.raises(RuntimeError, match="a defect"):
        main(["models"])


# --- help and imports


@pytest.mark.parametrize("name", NAMES)
def test_every_command_has_help_with_an_example_that_can_be_typed(name: str, capsys: pytest.CaptureFixture[str]):
    with pytest.raises(SystemExit) as left:
        main([name, "--help"])
    assert left.value.code == 0
    text = capsys.readouterr().out
    example = re.search(r"^example: (python -m vehgen .*)$", text, re.MULTILINE)
    assert example is not None
    words = shlex.split(example.group(1).partition(">")[0])[3:]
    assert words[0] == name
    assert make_parser().parse_args(words).command == name


def test_examples_on_bundled_models_work(capsys: pytest.CaptureFixture[str]):
    for command in COMMANDS:
        words = shlex.split(command.EXAMPLE.partition(">")[0])[3:]
        if words[0] in ("modes", "static", "effects", "models", "schema", "bench"):  # the others write files or read recordings
            assert main(words) == 0
            assert capsys.readouterr().out


def test_help_lists_every_command_and_no_command_prints_it(capsys: pytest.CaptureFixture[str]):
    with pytest.raises(SystemExit):
        main(["--help"])
    text = capsys.readouterr().out
    for command, name in zip(COMMANDS, NAMES, strict=True):
        assert re.search(rf"^ +{name}\s+{re.escape((command.__doc__ or '').split()[0])} ", text, re.MULTILINE)
    assert main([]) == 0
    assert capsys.readouterr().out == text
    assert main(["--version"]) == 0
    assert capsys.readouterr().out == f"{vehgen.__version__}\n"


@pytest.mark.parametrize(
    "code",
    [
        "import vehgen; dir(vehgen)",
        "import vehgen.commands",
        "import runpy, sys; sys.argv = ['vehgen', '--help']; runpy.run_module('vehgen', run_name='__main__')",
        "import runpy, sys; sys.argv = ['vehgen', '--version']; runpy.run_module('vehgen', run_name='__main__')",
        *(
            f"import runpy, sys; sys.argv = ['vehgen', '{name}', '--help']; runpy.run_module('vehgen', run_name='__main__')"
            for name in NAMES
        ),
    ],
)
def test_help_and_import_stay_light(code: str):
    watch = f"import atexit, sys\natexit.register(lambda: print('loaded', sorted({HEAVY!r} & set(sys.modules)), file=sys.stderr))\n"
    found = python("-c", watch + code)
    assert found.stderr == "loaded []\n"


def test_reading_a_bad_file_needs_no_heavy_package(work: Path):
    """A fault is found before sympy, numba or matplotlib are loaded."""
    (work / "bad.yaml").write_text("bodies:\n  body: {mas: 1 kg}\n")
    code = "import sys; from vehgen.commands import main; main(['build', 'bad.yaml'])\n"
    found = python("-c", code + f"print(sorted({HEAVY - {'pydantic', 'ruamel'}!r} & set(sys.modules)))", folder=work)
    assert found.stdout == "[]\n"


def test_the_packages_names_are_found_when_asked_for():
    code = "import vehgen; print([name for name in vehgen.__all__ if name != 'simulate' and not callable(getattr(vehgen, name))])"
    assert python("-c", code).stdout == "[]\n"
    assert set(vehgen.__all__) < set(dir(vehgen))
    with pytest.raises(AttributeError, match="module 'vehgen' has no attribute 'Vehicl'"):
        _ = vehgen.Vehicl


def test_no_name_of_the_package_hides_a_room():
    code = (
        "import vehgen; print(sorted(set(vehgen.__all__) & {'vehicle', 'mechanics', 'codegen', 'road', 'simulate', 'report', 'commands'}))"
    )
    assert python("-c", code).stdout == "[]\n"
