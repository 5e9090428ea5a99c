import json
import os
from importlib import import_module
from pathlib import Path

import numpy as np
import pytest

from tests.fit.recordings import sedan_truth, write_run
from vehgen.calibrate.calibration import Settings, calibrate_problem
from vehgen.calibrate.genetic import GeneticSearch
from vehgen.calibrate.result import CalibrationSummary
from vehgen.calibrate.summary import summarise
from vehgen.commands import main
from vehgen.errors import InputError
from vehgen.files.results import json_text
from vehgen.fit import processes
from vehgen.fit.problem import make_problem
from vehgen.fit.trial import load_trials

SMALL = ["--generations", "5", "--size", "20", "--starts", "1"]


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    return str(write_run(tmp_path_factory.mktemp("run"), "hump", sedan_truth()))


def test_calibrate_writes_vehicle_result_and_figures(run, tmp_path, capsys, monkeypatch):
    monkeypatch.setattr(processes, "WORTH_PROCESSES_S", 0.0)  # facts go to the processes, too
    out, facts = tmp_path / "out", tmp_path / "known.yaml"
    facts.write_text("kerb_mass: {value: 1500 kg, uncertainty: 300 kg}\n")
    assert main(["calibrate", "sedan2.yaml", run, "--facts", str(facts), "--out", str(out), "--json", *SMALL]) == 0
    data = json.loads(capsys.readouterr().out)
    assert data["rank"] == data["searched"] == 10
    assert data["provenance"]["seed"] == 1
    known = os.path.relpath(facts, Path(run).parent).replace(os.sep, "/")
    assert set(data["provenance"]["inputs"]) == {"hump.yaml", "hump.csv", "sedan2.yaml", known}
    low, high = data["parameters"]["kf"]["interval"]
    assert low < data["parameters"]["kf"]["value"] < high
    names = {path.name for path in out.iterdir()}
    assert {
        "sedan2_calibrated.yaml",
        "calibration.json",
        "search.json",
        "psd.png",
        "histories.png",
        "convergence.png",
        "intervals.png",
    } <= names
    assert json.loads((out / "calibration.json").read_text(encoding="utf-8"))["parameters"] == data["parameters"]

    assert main(["validate", str(out / "sedan2_calibrated.yaml"), run, "--out", str(tmp_path / "val"), "--json", "--astm", "level II"]) == 0
    data = json.loads(capsys.readouterr().out)
    assert data["worst_acceleration_error"] < 0.05
    assert len(data["channels"]) == 4
    for folder, name in ((out, "calibration.json"), (tmp_path / "val", "validation.json")):
        same_figures_again(folder, name, tmp_path / "again", capsys)


@pytest.mark.thorough
@pytest.mark.parametrize("factor", [1.0, 1000.0])
def test_a_channel_in_a_unit_that_nobody_stated_is_warned_of(tmp_path, capsys, factor):
    path = write_run(tmp_path, "hump", sedan_truth())
    rows = np.loadtxt(path.with_suffix(".csv"), delimiter=",", skiprows=1)
    rows[:, 1] *= factor
    np.savetxt(path.with_suffix(".csv"), rows, delimiter=",", header="t,F_az,F_q,R_az,R_q", comments="")
    assert main(["validate", "sedan2", str(path), "--out", str(tmp_path / "val"), "--json"]) == 0
    told = json.loads(capsys.readouterr().out)["warnings"]
    assert [item.split(" times ")[0].rsplit(" ", 1)[0] for item in told] == (["hump: F_az reads"] if factor > 1 else [])


def same_figures_again(folder, name, again, capsys):
    assert main(["report", str(folder / name), "--out", str(again), "--json"]) == 0
    files = [Path(path) for path in json.loads(capsys.readouterr().out)["files"]]
    assert {path.name for path in files} == {path.name for path in folder.glob("*.png")}
    for path in files:
        assert path.read_bytes() == (folder / path.name).read_bytes(), path.name
        path.unlink()


@pytest.mark.thorough
def test_a_calibration_survives_its_file(run, tmp_path):
    problem = make_problem(load_trials([run]))
    summary = summarise(calibrate_problem(problem, Settings(search=GeneticSearch(1, 10, 2), starts=1)), replicates=2)
    again = CalibrationSummary.from_dict(json.loads(json_text(summary)))
    assert again == summary
    assert again.parameters == summary.parameters
    assert [row[0] for row in again.table()[1]] == list(problem.space.names)
    with pytest.raises(InputError, match="read from a file"):
        again.vehicle_text(tmp_path, "x")


@pytest.mark.thorough
def test_calibrate_prints_tables_for_people(run, tmp_path, capsys):
    assert main(["calibrate", "sedan2.yaml", run, "--method", "shcm", "--sensors", "F", "--out", str(tmp_path / "o"), *SMALL]) == 0
    printed = capsys.readouterr().out
    assert "identified" in printed
    assert "body heave" in printed or "heave" in printed


@pytest.mark.thorough
def test_a_search_stopped_by_hand_leaves_its_best_and_goes_on(run, tmp_path, capsys, monkeypatch):
    from vehgen.calibrate.genetic import GeneticSearch

    advance, calls = GeneticSearch.advance, []

    def stop(self, state, *objectives):
        calls.append(1)
        if len(calls) == 3:
            raise KeyboardInterrupt
        return advance(self, state, *objectives)

    out = tmp_path / "out"
    arguments = ["calibrate", "sedan2.yaml", run, "--out", str(out), "--json", *SMALL]
    monkeypatch.setattr(GeneticSearch, "advance", stop)
    assert main(arguments) == 130
    assert json.loads(capsys.readouterr().out)["stopped"]
    assert (out / "sedan2_calibrated.yaml").is_file()
    monkeypatch.undo()
    assert main([*arguments, "--resume"]) == 0
    resumed = json.loads(capsys.readouterr().out)
    assert main([*arguments[:4], str(tmp_path / "whole"), *arguments[5:]]) == 0
    whole = json.loads(capsys.readouterr().out)
    assert resumed["parameters"] == whole["parameters"]
    assert resumed["history"] == whole["history"]


@pytest.mark.slow
def test_sensitivity_and_sensors(run, tmp_path, capsys):
    assert main(["sensitivity", "sedan2.yaml", run, "--out", str(tmp_path / "s"), "--json", "--parameters", "kf,mr"]) == 0
    data = json.loads(capsys.readouterr().out)
    assert set(data["channels"]["F_az"]) == {"kf", "mr"}
    assert len(data["channels"]["F_az"]["kf"]["index"]) == len(data["frequency_hz"])
    same_figures_again(tmp_path / "s", "sensitivity.json", tmp_path / "again", capsys)
    assert main(["sensors", "sedan2.yaml", run, "--count", "2", "--json"]) == 0
    best = json.loads(capsys.readouterr().out)["best"]
    assert best[1]["mean_error"] < best[0]["mean_error"]


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["--band", "5"], "--band wants two frequencies"),
        (["--method", "dhmc"], "did you mean 'dhcm'"),
        (["--size", "7"], "even number"),
        (["--resume"], "no search to resume"),
        (["--sensors", "X"], "no run has a sensor 'X'"),
        (["--facts", "nowhere.yaml"], "nowhere.yaml"),
        (["--combination", "k9/mf"], "names k9"),
        (["--scheduler", "tcp://127.0.0.1:1"], "no Dask scheduler answers"),
    ],
)
def test_what_cannot_be_done_is_said_in_one_line(run, tmp_path, capsys, arguments, said):
    if "--scheduler" in arguments:
        pytest.importorskip("distributed")
    assert main(["calibrate", "sedan2.yaml", run, "--out", str(tmp_path / "o"), *SMALL, *arguments]) == 2
    error = capsys.readouterr().err
    assert said in error
    assert error.count("\n") == 1


@pytest.mark.thorough
@pytest.mark.parametrize("command", [("sensors", "--count", "1"), ("sensitivity", "--out", "s")])
def test_a_terminal_is_told_how_far_sensors_and_sensitivity_are(command, run, tmp_path, capsys, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("TTY_COMPATIBLE", "1")
    assert main([command[0], "sedan2.yaml", run, "--parameters", "kf,mr", *command[1:]]) == 0
    told = capsys.readouterr().err
    assert "derivatives" in told
    assert "2/2" in told
    assert "left" in told


@pytest.mark.thorough
def test_the_result_is_told_before_its_figures_are_drawn(run, tmp_path, capsys, monkeypatch):
    def draw(*_):
        raise InputError("no figures")

    monkeypatch.setattr(import_module("vehgen.report.plots.calibration_plots"), "save_calibration_figures", draw)
    assert main(["calibrate", "sedan2.yaml", run, "--out", str(tmp_path / "o"), *SMALL]) == 2
    told = capsys.readouterr()
    assert "sedan2: parameters" in told.out
    assert told.err.splitlines()[-1] == "error: no figures"
    assert (tmp_path / "o" / "calibration.json").is_file()
