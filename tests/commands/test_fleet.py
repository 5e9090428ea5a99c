"""`diagnose --fleet`: one table, one page, and what is refused."""

import csv
import json

import pytest

from tests.fit.recordings import sedan_truth, write_run
from vehgen.commands import main


@pytest.fixture
def fleet(work):
    for name in ("good", "bad"):
        (work / "fleet" / name).mkdir(parents=True)
    write_run(work / "fleet" / "good", "hump", sedan_truth())
    (work / "fleet" / "bad" / "run.yaml").write_text("vehicle: sedan2.yaml\nspeed: fast\n")
    return work


@pytest.mark.thorough
def test_a_fleet_becomes_a_table_and_a_page(fleet, capsys):
    assert main(["diagnose", "--fleet", "fleet", "--effects", "dry_friction", "--json"]) == 2
    captured = capsys.readouterr()
    data = json.loads(captured.out)
    assert captured.err == ""
    assert {row["name"]: row["status"] for row in data["rows"]} == {"bad": "failed", "good": "finished"}
    out = fleet / "fleet_diagnosis"
    with (out / "fleet.csv").open(newline="") as table:
        told = {row["vehicle"]: row for row in csv.DictReader(table)}
    assert told["bad"]["error"].startswith("fleet/bad/run.yaml:2:8: ")
    assert told["good"]["verdict"] == data["rows"][1]["verdict"]["verdict"]
    page = (out / "index.html").read_text(encoding="utf-8")
    assert (out / "good" / "report.html").is_file()
    assert 'href="good/report.html"' in page
    main(["diagnose", "--fleet", "fleet", "--effects", "dry_friction"])
    printed = capsys.readouterr().out
    assert "2 vehicles: 1 failed, 1 " in printed
    assert "wrote fleet_diagnosis/index.html" in printed


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (("--fleet", "fleet", "sedan2.yaml", "fleet/good/hump.yaml"), "--fleet takes the vehicles and runs of a folder"),
        pytest.param(
            ("sedan2.yaml", "fleet/good/hump.yaml", "--scheduler", "tcp://127.0.0.1:1"), "no Dask scheduler answers", marks=pytest.mark.slow
        ),
        (("--fleet", "fleet", "--out", "fleet/out"), "--out: a folder outside of fleet was expected"),
        (("--fleet", "fleet", "--effects", "dry_frictio"), "did you mean 'dry_friction'"),
        (("--fleet", "fleet", "--library", "none.yaml"), "no file none.yaml"),
        ((), "the following arguments are required: VEHICLE, RUN"),
        (("sedan2.yaml",), "the following arguments are required: RUN"),
    ],
)
def test_what_cannot_be_done_is_said_in_one_line(fleet, capsys, arguments, said):
    assert main(["diagnose", *arguments]) == 2
    error = capsys.readouterr().err
    assert said in error
    assert error.count("\n") == 1
    assert not (fleet / "fleet_diagnosis").exists()


def test_files_of_others_are_left_alone(fleet, capsys):
    own = fleet / "fleet_diagnosis" / "good" / "report.html"
    own.parent.mkdir(parents=True)
    own.write_text("mine")
    assert main(["diagnose", "--fleet", "fleet", "--json"]) == 2
    assert "was not written by vehgen" in json.loads(capsys.readouterr().out)["rows"][1]["error"]
    assert own.read_text() == "mine"
