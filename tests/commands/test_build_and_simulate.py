"""`build` and `simulate`: what they print, what they write and where, and a response against an independent integration."""

from __future__ import annotations

import csv
import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import scipy.integrate
import scipy.io

from tests.bundled import few
from vehgen.commands import main
from vehgen.files.manifest import MANIFEST

RUN = """\
vehicle: quarter_car
speed: 2 m/s
duration: 3 s
sample: 10 ms
road:
  - hump: {shape: half_sine, length: 0.5 m, height: 0.03 m, at: 1 m}
sensors:
  L1: {body: body, channels: {acceleration: az, displacement: z}}
outputs:
  load: {axle: axle1, quantity: tyre_load}
  travel: {axle: axle1, quantity: suspension_travel}
"""


@pytest.fixture(scope="module")
def cache(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder for this module's kernels."""
    return tmp_path_factory.mktemp("cache")


@pytest.fixture
def work(tmp_path: Path, cache: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """An empty working folder."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("VEHGEN_CACHE", str(cache))
    return tmp_path


def written(folder: Path) -> set[str]:
    return {str(path.relative_to(folder)) for path in folder.rglob("*") if path.is_file() and path.name != MANIFEST}


def test_build_writes_its_folder_and_nothing_else(work: Path, capsys: pytest.CaptureFixture[str]):
    assert main(["build", "quarter_car", "--json"]) == 0
    captured = capsys.readouterr()
    assert captured.err == ""
    found: dict[str, Any] = json.loads(captured.out)
    assert found["vehicle"] == "quarter_car"
    assert found["coordinates"] == ["heave.body", "hop.axle1"]
    assert found["parameters"]["mB"] == 10000.0
    assert [mode["undamped_hz"] for mode in found["modes"]] == pytest.approx([1.1112478077533552, 7.208241791310187])
    assert found["axles"] == {"axle1": pytest.approx(107910.0)}
    assert found["hinges"] == {}
    assert {"setup", "step", "sample", "written_out", "after_cse"} <= set(found["operation_counts"])
    assert all(isinstance(count, int) and count > 0 for count in found["operation_counts"].values())
    assert found["warnings"] == []
    assert found["folder"] == str(Path("build") / "quarter_car")
    assert written(work) == {f"build/quarter_car/{name}" for name in found["files"]}
    assert {"kernel.py", "kernel_legend.txt", "equations.txt", "equations.tex", "drawing.svg", "modes.svg", "index.html"} <= set(
        found["files"]
    )


@pytest.mark.thorough
@pytest.mark.parametrize("name", few(("truck_walking_beam", "tractor5_module")))
def test_report_draws_a_built_vehicle_again_from_its_file(work: Path, capsys: pytest.CaptureFixture[str], name: str):
    assert main(["build", name, "--out", "first"]) == 0
    assert main(["report", "first/build.json", "--out", "again", "--json"]) == 0
    drawn = written(work / "again")
    assert drawn == written(work / "first") - {"build.json"}
    for name in drawn:
        assert (work / "first" / name).read_bytes() == (work / "again" / name).read_bytes(), name


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"vehicle": {}}, "holds no vehicle's data"),
        ({"vehicle": {"extends": "../secret.yaml"}}, "secret"),
        ({"vehicle": {"name": "__import__('os')", "bodies": {"b": {"mass": "__import__('os')"}}}}, "build.json"),
        ({"values": {}}, "other parameters than its vehicle has"),
        ({"modes": {"coordinates": [], "modes": "many"}}, "`modes.modes`"),
    ],
)
def test_a_damaged_build_is_refused_in_one_line(work: Path, capsys: pytest.CaptureFixture[str], change: dict[str, Any], said: str):
    assert main(["build", "quarter_car", "--no-plots", "--out", "a"]) == 0
    data = json.loads((work / "a" / "build.json").read_text(encoding="utf-8"))
    (work / "build.json").write_text(json.dumps({**data, "plots": True, **change}), encoding="utf-8")
    capsys.readouterr()
    assert main(["report", "build.json", "--out", "b"]) == 2
    error = capsys.readouterr().err
    assert said in error
    assert error.count("\n") == 1
    assert not (work / "b").exists()


def test_build_without_plots_into_a_chosen_folder_twice_the_same(work: Path, capsys: pytest.CaptureFixture[str]):
    assert main(["build", "quarter_car", "--no-plots", "--out", "a/b"]) == 0
    text = capsys.readouterr().out
    assert "Quarter car: layout" in text
    assert "107.910" in text
    assert "a/b/index.html" in text
    files = written(work)
    assert {"a/b/kernel.py", "a/b/index.html"} <= files
    assert not any(name.endswith(("drawing.svg", "modes.svg")) for name in files)
    kernel = (work / "a" / "b" / "kernel.py").read_bytes()
    assert main(["build", "quarter_car", "--no-plots", "--out", "c"]) == 0
    assert (work / "c" / "kernel.py").read_bytes() == kernel
    compile(kernel, "kernel.py", "exec")


def test_build_into_a_file_is_refused(work: Path, capsys: pytest.CaptureFixture[str]):
    (work / "taken").write_text("mine")
    assert main(["build", "quarter_car", "--no-plots", "--out", "taken"]) == 2
    assert capsys.readouterr().err.startswith("error: cannot write taken")
    assert written(work) == {"taken"}
    assert (work / "taken").read_text() == "mine"


def quarter_car_response(time: np.ndarray) -> dict[str, np.ndarray]:
    """Integrate the quarter car of VBI-2D over the hump of RUN by its equations of motion."""
    mB, mG, kS, cS, kT, cT, g = 1e4, 1e3, 1e6, 1e4, 1e6, 1e4, 9.81

    def road(t: float) -> tuple[float, float]:
        s = 2.0 * t - 1.0
        if not 0.0 <= s <= 0.5:
            return 0.0, 0.0
        return 0.03 * np.sin(np.pi * s / 0.5), 0.03 * np.pi / 0.5 * 2.0 * np.cos(np.pi * s / 0.5)

    def forces(t: float, state: np.ndarray) -> tuple[float, float]:
        z, u, dz, du = state
        w, dw = road(t)
        return kS * (u - z) + cS * (du - dz), kT * (w - u) + cT * (dw - du)

    def rate(t: float, state: np.ndarray) -> list[float]:
        suspension, tyre = forces(t, state)
        return [state[2], state[3], suspension / mB, (tyre - suspension) / mG]

    states = [np.zeros(4)]
    for start, end in ((0.0, 0.5), (0.5, 0.75), (0.75, float(time[-1]))):
        inner = time[(time > start + 1e-9) & (time <= end + 1e-9)]
        found = scipy.integrate.solve_ivp(rate, (start, inner[-1]), states[-1], "DOP853", t_eval=inner, rtol=1e-10, atol=1e-12)
        states += list(found.y.T)
    pairs = [forces(t, state) for t, state in zip(time, states, strict=True)]
    return {
        "az": np.array([suspension for suspension, _ in pairs]) / mB,
        "z": np.array([state[0] for state in states]),
        "load": np.array([tyre for _, tyre in pairs]) + (mB + mG) * g,
        "travel": np.array([state[1] - state[0] for state in states]),
    }


def read(path: Path) -> dict[str, np.ndarray]:
    with path.open() as file:
        rows = list(csv.DictReader(file))
    return {name: np.array([float(row[name]) for row in rows]) for name in rows[0]}


def test_simulate_follows_the_equations_of_motion(work: Path, capsys: pytest.CaptureFixture[str]):
    (work / "run.yaml").write_text(RUN)
    assert main(["simulate", "run.yaml", "--json"]) == 0
    captured = capsys.readouterr()
    assert captured.err == ""
    found = json.loads(captured.out)
    assert set(found) == {"channels", "warnings", "files"}
    assert written(work) == {"run.yaml", "run_response.csv"}
    assert [Path(name).name for name in found["files"]] == ["run_response.csv"]
    response = read(work / "run_response.csv")
    assert list(response) == ["t", "az", "z", "load", "travel"]
    assert response["t"] == pytest.approx(np.arange(301) * 0.01)
    exact = quarter_car_response(response["t"])
    inside = ~np.isclose(response["t"][:, None], [0.5, 0.75]).any(axis=1)  # where the hump begins and ends, the tyre's damping force jumps
    for name, values in exact.items():
        error = np.linalg.norm((response[name] - values)[inside]) / np.linalg.norm(values - values[0])
        assert error < 2e-4, name
    units = {"az": "m/s^2", "z": "m", "load": "N", "travel": "m"}
    assert {item["name"]: item["unit"] for item in found["channels"]} == units
    for item in found["channels"]:
        assert item["peak"] == pytest.approx(np.abs(response[item["name"]]).max(), rel=1e-6)


def test_simulate_draws_and_writes_where_it_is_told(work: Path, capsys: pytest.CaptureFixture[str]):
    (work / "runs").mkdir()
    (work / "runs" / "run.yaml").write_text(RUN)
    assert main(["simulate", "runs/run.yaml", "--out", "out/r.csv", "--plot"]) == 0
    text = capsys.readouterr().out
    assert "wrote out/r.csv" in text
    assert "wrote out/r.png" in text
    assert written(work) == {"runs/run.yaml", "out/r.csv", "out/r.png"}
    assert (work / "out" / "r.png").read_bytes().startswith(b"\x89PNG")


def test_simulate_writes_for_matlab_what_it_writes_as_text(work: Path, capsys: pytest.CaptureFixture[str]):
    (work / "run.yaml").write_text(RUN)
    assert main(["simulate", "run.yaml", "--out", "r.csv"]) == 0
    assert main(["simulate", "run.yaml", "--out", "r.mat"]) == 0
    capsys.readouterr()
    columns = np.genfromtxt("r.csv", delimiter=",", names=True)
    found = scipy.io.loadmat("r.mat", squeeze_me=True, chars_as_strings=True)
    np.testing.assert_allclose(found["t"], columns["t"], rtol=1e-8)
    for name, values in zip(found["channels"], found["values"].T, strict=True):
        np.testing.assert_allclose(values, columns[name], rtol=1e-8, atol=1e-12)
    assert len(found["units"]) == len(found["channels"]) == len(columns.dtype.names) - 1


def test_simulate_writes_nothing_that_it_does_not_know(work: Path, capsys: pytest.CaptureFixture[str]):
    (work / "run.yaml").write_text(RUN)
    assert main(["simulate", "run.yaml", "--out", "r.npz"]) == 2
    assert "--out: a response is written as .csv or .mat or .txt; found 'r.npz'" in capsys.readouterr().err
    assert not Path("r.npz").exists()


def test_simulate_says_when_a_wheel_leaves_the_road(work: Path, capsys: pytest.CaptureFixture[str]):
    (work / "run.yaml").write_text(RUN.replace("height: 0.03 m", "height: 0.3 m"))
    assert main(["simulate", "run.yaml", "--json"]) == 0
    assert any("axle1" in warning for warning in json.loads(capsys.readouterr().out)["warnings"])
