"""Diagnoses of recordings from the independent generator."""

import json

import pytest
from benchmarks.hidden_effects.generator import Effect

from vehgen.commands import main
from vehgen.diagnose.detect.noise_floor import find_noise_floor
from vehgen.diagnose.pipeline import diagnose_trials, split_runs
from vehgen.fit.trial import load_trials
from vehgen.vehicle import load_vehicle


@pytest.fixture(scope="module")
def nothing(record):
    return record()


@pytest.fixture(scope="module")
def cubic(record):
    return record(Effect("cubic_stiffness", "rear", {"k3": 1e8}))


def test_the_noise_floor_is_that_of_the_phones(nothing):
    floor = find_noise_floor(load_trials(nothing))
    for noise in floor.noises.values():
        assert noise.sigma[0] == pytest.approx(0.0125, rel=0.4)
        assert noise.sigma[1] == pytest.approx(5.3e-4, rel=0.3)
    assert floor.corrected == ()


def test_nothing_hidden_is_found_to_be_nothing(nothing):
    found = diagnose_trials(load_trials(nothing))
    assert found.verdict.verdict == "no_missing_effect"
    assert found.detection.chi < 1.06


def test_a_hidden_spring_is_placed_named_and_measured_and_the_order_of_runs_does_not_matter(cubic):
    trials = load_trials(cubic)
    found = diagnose_trials(trials)
    assert {item.place.label for item in found.passed} == {"suspension rear", "tyre rear"}
    assert found.verdict.verdict == "named"
    effect = found.verdict.effects[0]
    assert (effect.name, effect.place) == ("cubic_stiffness", "rear")
    assert effect.parameters["k3"].value == pytest.approx(1e8, rel=0.05)
    assert found.verdict.reason.startswith("Cubic stiffness of about ")
    assert " in the rear suspension: it explains " in found.verdict.reason
    assert effect.validation_gain > 0.98
    assert found.verdict.gap.after < 1.2 < 5 < found.verdict.gap.before
    assert any("random laws at the same place" in note for note in found.verdict.notes)
    assert diagnose_trials(trials[::-1]).verdict.to_dict() == found.verdict.to_dict()


def test_the_command_leaves_report_and_vehicle(cubic, tmp_path, capsys):
    paths = [str(path) for path in cubic]
    assert main(["diagnose", "sedan2.yaml", *paths, "--effects", "cubic_stiffness,dry_friction", "--out", str(tmp_path), "--json"]) == 0
    data = json.loads(capsys.readouterr().out)
    assert data["verdict"] == "named"
    vehicle = load_vehicle(data["vehicle_file"])
    assert vehicle.values()["cubic_stiffness_rear_k3"] == pytest.approx(data["effects"][0]["parameters"]["k3"]["value"])
    page = (tmp_path / "report.html").read_text(encoding="utf-8")
    assert page.count("<svg") >= 4
    assert "suspension rear" in page


def test_a_sensor_that_reads_too_much_is_told_from_a_force(record):
    paths = record(Effect("sensor_gain", "F_az", {"error": 0.15}))
    found = diagnose_trials(load_trials(paths)).verdict
    assert found.verdict == "named"
    assert (found.effects[0].name, found.effects[0].place) == ("sensor_gain", "F_az")
    low, high = found.effects[0].parameters["gain"].interval
    assert low - 0.005 <= 1.15 <= high + 0.005


def test_one_run_names_nothing(cubic):
    found = diagnose_trials(load_trials(cubic[:1])).verdict
    assert found.verdict == "insufficient_data"
    assert "three runs" in found.next_experiment


def test_untouched_runs_lie_between_the_extremes(nothing):
    training, held = split_runs(load_trials(nothing))
    assert [trial.name for trial in held] == ["low"]
    assert [trial.name for trial in training] == ["rough", "high", "fast"]


def test_an_unknown_effect_is_refused_with_the_nearest_name(nothing, tmp_path, capsys):
    assert main(["diagnose", "sedan2.yaml", str(nothing[0]), "--effects", "dry_frction", "--out", str(tmp_path)]) == 2
    assert "did you mean 'dry_friction'" in capsys.readouterr().err


def test_a_copy_of_a_run_is_refused(nothing, tmp_path, capsys):
    folder = nothing[0].parent
    copy = folder / "twin.yaml"
    copy.write_text((folder / "low.yaml").read_text(encoding="utf-8"), encoding="utf-8")
    try:
        paths = [str(path) for path in (*nothing, copy)]
        assert main(["diagnose", "sedan2.yaml", *paths, "--out", str(tmp_path)]) == 2
    finally:
        copy.unlink()
    assert "hold the same recording" in capsys.readouterr().err
