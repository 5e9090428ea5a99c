"""`vehgen export`: every format by its name, one-line refusals, nothing half-written."""

import json
import re

import pytest

from tests.commands.calls import run_json
from vehgen.commands import export as command
from vehgen.commands import main, make_parser
from vehgen.export import EXPORT_FORMATS


@pytest.fixture
def work(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    return tmp_path


RUN = """
vehicle: sedan2
speed: 2 m/s
duration: 2 s
sensors: {seat: {body: body, x: 0.2 m, channels: {acceleration: seat_az}}}
outputs: {front_force: {axle: front, quantity: tyre_force}}
forces: {engine: {body: body, x: 1 m, harmonic: {amplitude: 100 N, frequency: 5 Hz}}}
"""


def test_the_help_names_every_format():
    parser = make_parser()
    text = next(action for action in parser._subparsers._group_actions[0].choices["export"]._actions if action.dest == "to").help
    assert text.split(", ") == list(EXPORT_FORMATS)
    assert command.EXAMPLE.split()[4] in EXPORT_FORMATS


def test_a_set_and_a_runs_sensors(work, capsys):
    (work / "run.yaml").write_text(RUN)
    found = run_json(capsys, "export", "tractor5", "--to", "json", "--set", "SHCM-1")
    assert found == {"files": ["tractor5.json"]}
    by_set = json.loads((work / "tractor5.json").read_text())
    main(["export", "tractor5", "--to", "json", "--out", "own.json"])
    assert by_set["K"] != json.loads((work / "own.json").read_text())["K"]
    assert main(["export", "sedan2", "--to", "json", "--run", "run.yaml", "--out", "sedan.json"]) == 0
    sedan = json.loads((work / "sedan.json").read_text())
    assert [item["name"] for item in sedan["outputs"]] == ["seat_az", "front_force"]
    assert [item["name"] for item in sedan["forces"]] == ["engine"]


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["--to", "jsn"], "error: --to: unknown format 'jsn'; did you mean 'json'.\n"),
        (["--to", "json", "--out", "a/"], "error: --out names a file to write; found 'a/', a folder\n"),
        (["--to", "json", "--out", "own.yaml"], "error: --out: the name of a file of the format json ends in .json; found 'own.yaml'\n"),
        (["--to", "json", "--out", "mine.json"], "error: mine.json exists and was not written by vehgen .*\n"),
        (["--to", "json", "--step", "nan"], "error: --step: a time step is 1e-06 s to 0.1 s, found nan\n"),
        (["--to", "json", "--step", "quick"], "error: argument --step: invalid float value: 'quick'.*\n"),
        (["--to", "json", "--set", "x"], "error: .*no parameter set 'x'.*\n"),
        (["--to", "c", "--out", "mine.json"], "error: cannot write mine.json/sedan2: mine.json is not a folder\n"),
        (["--to", "fmu", "--out", "a.zip"], "error: --out: the name of a file of the format fmu ends in .fmu; found 'a.zip'\n"),
        (["--to", "json", "--run", "none.yaml"], "error: .*none.yaml.*\n"),
        ([], "error: the following arguments are required: --to; .*\n"),
    ],
)
def test_refusals_are_one_line(work, capsys, words, message):
    (work / "mine.json").write_text("mine")
    assert main(["export", "sedan2", *words]) == 2
    assert re.fullmatch(message, capsys.readouterr().err)
    assert [path.name for path in work.iterdir()] == ["mine.json"]


def test_laws_are_refused_in_one_line_and_may_be_left_out(work, capsys):
    text = "extends: sedan2\nname: own\naxles: {front: {suspension: {laws: [{dry_friction: {force: 1 kN}}]}}}\n"
    (work / "own.yaml").write_text(text)
    assert main(["export", "own.yaml", "--to", "npz"]) == 2
    assert re.fullmatch("error: own: the force law dry_friction .* and --linear leaves it out\n", capsys.readouterr().err)
    assert main(["export", "own.yaml", "--to", "npz", "--linear"]) == 0
    assert "the force laws of own are left out" in capsys.readouterr().err
    assert main(["export", "own.yaml", "--to", "latex", "--linear"]) == 0  # describes them all the same
    assert capsys.readouterr().err == ""
