"""MAT-files read back by scipy; function files by a parser of their literals, and by GNU Octave where it is."""

import json
import re
import shutil
import subprocess

import numpy as np
import pytest
import scipy.io
import scipy.linalg

from tests.bundled import few
from tests.export.vehicles import TEXT, hostile, sedan_with, truck
from vehgen.errors import InputError
from vehgen.export import export
from vehgen.simulate import natural_modes
from vehgen.vehicle import bundled_models

OCTAVE = shutil.which("octave-cli") or shutil.which("octave")
STATEMENT = re.compile(
    r"  model\.(\w+) = (?:\[\n((?:    [-+0-9.e, ]+\n)+)  \];|zeros\((\d+), (\d+)\);|\{\n((?:    '(?:[^'\n]|'')*'\n)+)  \};"
    r"|(cell\(0, 1\));|('(?:[^'\n]|'')*');)\n"
)


def parse(text):
    """Return the fields of a function file; every line must be its head, a comment, or one of the literal statements."""
    head, comments, rest = re.fullmatch(r"function model = (\w+)\(\)\n((?:%[^\n]*\n)*)\n(.*)end\n", text, re.DOTALL).groups()
    fields, end = {}, 0
    for match in STATEMENT.finditer(rest):
        assert match.start() == end, rest[end : match.start()]
        end = match.end()
        name, rows, height, width, cells, empty, one = match.groups()
        if rows:
            fields[name] = np.array([[float(item) for item in row.split(",")] for row in rows.splitlines()])
        elif height:
            fields[name] = np.zeros((int(height), int(width)))
        else:
            texts = [line.strip()[1:-1].replace("''", "'") for line in (cells or one or "").splitlines()]
            fields[name] = [] if empty else texts if cells else texts[0]
    assert end == len(rest)
    return head, comments, fields


def frequencies(K, M):
    return np.sqrt(scipy.linalg.eigh(K, M, eigvals_only=True)) / (2 * np.pi)


@pytest.mark.parametrize("name", few(bundled_models()))
def test_every_bundled_vehicle_keeps_its_frequencies(name, tmp_path):
    expected = [mode.undamped_hz for mode in natural_modes(name)]
    (path,) = export(name, "mat", tmp_path / "a.mat", linear=True)
    found = scipy.io.loadmat(path)
    assert frequencies(found["K"], found["M"]) == pytest.approx(expected, rel=1e-9)
    (path,) = export(name, "m", tmp_path / "own_name.m", linear=True)
    function, comments, fields = parse(path.read_text(encoding="utf-8"))
    assert function == "own_name"
    assert comments.startswith("%OWN_NAME ")
    assert frequencies(fields["K"], fields["M"]) == pytest.approx(expected, rel=1e-9)
    assert fields.keys() == {key for key in found if not key.startswith("__")}


def test_both_hold_what_json_holds(tmp_path):
    paths = [export(truck(), name, tmp_path / f"truck.{name}")[0] for name in ("json", "mat", "m")]
    data, mat = json.loads(paths[0].read_text()), scipy.io.loadmat(paths[1])
    _, comments, fields = parse(paths[2].read_text())
    for name in ("M", "C", "K", "P", "Q"):
        assert (mat[name] == data[name]).all()
        assert (fields[name] == data[name]).all()
    assert fields["F"].shape == mat["F"].shape == (4, 0)
    names = [item["name"] for item in data["inputs"]]
    assert [cell[0] for cell in mat["input_names"][:, 0]] == names == fields["input_names"]
    assert mat["vehicle"].tolist() == ["truck"]
    assert mat["parameter_values"].tolist() == [[6000.0], [3000.0], [0.0]]  # the last moves the sensors
    assert fields["static_axle_loads"][:, 0].tolist() == list(data["static"]["axles"].values())
    assert "%   mB = 6000.0 kg: sprung mass\n" in comments
    assert export(truck(), "mat", tmp_path / "again.mat")[0].read_bytes() == paths[1].read_bytes()


def test_hostile_names_stay_texts(tmp_path):
    (path,) = export(hostile(), "mat", tmp_path / "a.mat")
    assert scipy.io.loadmat(path)["output_names"][0, 0].tolist() == [TEXT]
    (path,) = export(hostile(), "m", tmp_path / "a.m")
    _, comments, fields = parse(path.read_text(encoding="utf-8"))
    assert fields["output_names"][0].startswith("*/ int x;")
    assert "\\n%{\\n'); system('touch PWNED')" in fields["output_names"][0]
    assert not re.search(r"^\s*%\{\s*$", comments, re.MULTILINE)


@pytest.mark.parametrize(("stem", "better"), [("5axles", "v_5axles"), ("a-b", "a_b"), ("end", "v_end"), ("a" * 70, "a" * 63)])
def test_a_function_must_be_called_as_its_file(stem, better, tmp_path):
    with pytest.raises(InputError, match=f"`out`: MATLAB calls a function by its file's name.* try {better}.m"):
        export("sedan2", "m", tmp_path / f"{stem}.m")
    assert list(tmp_path.iterdir()) == []


def test_the_default_name_can_be_called(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    vehicle = truck().with_changes(name="5-axle")
    assert [path.name for path in export(vehicle, "m")] == ["v_5_axle.m"]
    assert [path.name for path in export(vehicle, "mat")] == ["5-axle.mat"]


@pytest.mark.parametrize("name", ["mat", "m"])
def test_force_laws_are_refused_by_name(name, tmp_path):
    with pytest.raises(InputError, match=f"the force law bump_stop of suspension front .* cannot be carried by {name}"):
        export(sedan_with("bump_stop"), name, tmp_path / f"a.{name}")
    assert list(tmp_path.iterdir()) == []


@pytest.mark.skipif(OCTAVE is None, reason="GNU Octave is not installed")
def test_octave_runs_the_function_and_reads_the_mat_file(tmp_path):
    export("vbi2d_2A3", "m", tmp_path / "truck.m")
    export("vbi2d_2A3", "mat", tmp_path / "data.mat")
    script = "model = truck(); d = load('data.mat'); printf('%.9f ', sort(sqrt(eig(model.K, d.M)))/(2*pi)); printf(model.axle_names{1});"
    done = subprocess.run([OCTAVE, "--eval", script], cwd=tmp_path, capture_output=True, text=True, check=True)
    *found, axle = done.stdout.split()
    assert [float(item) for item in found] == pytest.approx([mode.undamped_hz for mode in natural_modes("vbi2d_2A3")], rel=1e-7)
    assert axle == "axle1"
