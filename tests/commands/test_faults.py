"""What commands say of faults: one line, exit code 2, no traceback; and of Ctrl-C and closed pipes."""

from __future__ import annotations

import os
import shlex
import subprocess
import sys
import warnings
from collections.abc import Callable
from pathlib import Path

import pytest

from tests.commands.calls import python
from vehgen.commands import main
from vehgen.errors import ModelWarning

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
    "folder": ("name: ../../up\nextends: quarter_car\n", "1:7: '../../up' cannot be a name"),
}


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
        ("vehicle: quarter_car\nspeed: 1 m/s\n", "run.yaml:1:1: a run without a hump or recording needs `duration`, e.g. 10 s"),
        (
            "vehicle: quarter_car\nspeed: 1 m/s\nset: a\nduration: 1 s\n",
            "run.yaml:3:6: quarter_car has no parameter set 'a'; none is declared",
        ),
        (
            "vehicle: quarter_car\nspeed: 1 m/s\nduration: 1 s\nroad:\n  - profile: {file: absent.csv}\n",
            "run.yaml:5:21: no file absent.csv",
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
        (["static", "floating.yaml"], "error: floating.yaml:2:3: singular stiffness: nothing holds heave.body against gravity"),
        (["modes", "sedan2", "--set=--"], "error: --set wants a value; found '--'"),
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


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["modes"], "the following arguments are required: FILE; `vehgen modes --help` lists what is known"),
        (["mods", "tractor5"], "argument COMMAND: invalid choice: 'mods'; did you mean 'modes'"),
        (["modes", "tractor5", "--sett", "a"], "unrecognized arguments: --sett a; did you mean '--set'?; `vehgen modes --help` lists"),
        (["models", "\x1b[2J\u202e\n" + "x" * 1000], "unrecognized arguments: \\x1b[2J\\u202e\\nxxx"),
        (["sensors", "sedan2", "run.yaml", "--count", "\u202e"], "argument --count: invalid int value: '\\u202e'; "),
    ],
)
def test_wrong_arguments_are_one_line(arguments: list[str], message: str, capsys: pytest.CaptureFixture[str]):
    assert main(arguments) == 2
    captured = capsys.readouterr()
    assert captured.out == ""
    assert captured.err.startswith(f"error: {message}")
    assert captured.err.count("\n") == 1
    assert len(captured.err) < 700


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


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (["--hump", "half_sine,length=1e9,height=0.03"], "--hump: the length of a hump is 0.001 to 50 m in magnitude, found 1e+09 m"),
        (["--speed", "1e6"], "--speed: a speed is 0.01 to 150 m/s in magnitude, found 1e+06 m/s"),
        (["--speed", "1e-6"], "--speed: a speed is 0.01 to 150 m/s"),
        (["--footprint", "1e9"], "--footprint: a tyre's footprint is 0.001 to 2 m"),
        (["--footprint", "nan"], "--footprint must be a positive number, found nan"),
        (["--lead", "1e12"], "--lead: a place along the road is at most 1e+06 m"),
        (["--top", "-1", "--rate", "100"], "the top of the band must be from 1 to 500 Hz, found -1 Hz"),
        (["--rate", "1e9"], "the rate must be from 50 to 1000 Hz"),
        (["--hump", ""], "--hump: unknown shape ''"),
        (["--sensor", "L1:body=body,behind=body,distance=1e9"], "--sensor L1 distance: a length on a vehicle is at most 1000 m"),
    ],
)
def test_options_of_import_beyond_all_limits(options: list[str], message: str, work: Path, capsys: pytest.CaptureFixture[str]):
    (work / "a.csv").write_text("t,a\n0,1\n1,2\n")
    given = dict(zip(options[::2], options[1::2], strict=True))
    usual = {
        "--vehicle": "sedan2",
        "--sensor": "L1:body=body",
        "--hump": "half_sine,length=0.5,height=0.03",
        "--speed": "2",
        "--out": "r.yaml",
    }
    arguments = [part for pair in {**usual, **given}.items() for part in pair]
    assert main(["import", "a.csv", *arguments]) == 2
    captured = capsys.readouterr()
    assert message in captured.err
    assert captured.err.count("\n") == 1
    assert [path.name for path in work.iterdir()] == ["a.csv"]


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (["--seed", "-1"], "--seed: a seed is a whole number from 0 to 9223372036854775807, found -1"),
        (["--size", "1000000000"], "--size: a whole number from 2 to 100000 was expected, found 1000000000"),
        (["--generations", "-5"], "--generations: a whole number from 0 to 1000000 was expected"),
        (["--bootstrap", "-5"], "--bootstrap: a whole number from 0"),
        (["--height-error", "-0.1"], "--height-error must not be below 0, found -0.1"),
        (["--speed-error", "inf"], "--speed-error: a relative uncertainty is at most 1 in magnitude, found inf"),
    ],
)
def test_options_of_calibrate_beyond_all_limits(options: list[str], message: str, work: Path, capsys: pytest.CaptureFixture[str]):
    assert main(["calibrate", "sedan2", "absent.yaml", *options]) == 2
    captured = capsys.readouterr()
    assert captured.err.startswith(f"error: {message}")
    assert captured.err.count("\n") == 1
    assert list(work.iterdir()) == []


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="needs pipes")
@pytest.mark.parametrize("command", [["modes", "pipe"], ["simulate", "pipe"], ["simulate", "run.yaml"], ["effects", "--library", "pipe"]])
def test_a_pipe_as_a_file_is_one_line(command: list[str], work: Path, capsys: pytest.CaptureFixture[str]):
    os.mkfifo(work / "pipe")
    (work / "run.yaml").write_text("vehicle: quarter_car\nspeed: {file: pipe}\nduration: 1 s\n")
    assert main(command) == 2
    captured = capsys.readouterr()
    assert "pipe is a pipe, socket or device" in captured.err
    assert captured.err.count("\n") == 1
