"""Diagnoses of recordings from the independent generator."""

import shutil
from types import SimpleNamespace

import numpy as np
import pytest
from benchmarks.hidden_effects.generator import Case, Effect, simulate_case

from tests.diagnose.conftest import CUBIC, HUMPS, RUNS
from vehgen.commands import main
from vehgen.diagnose.detect.splitting import split_by_gap
from vehgen.diagnose.pipeline import diagnose_trials, split_runs
from vehgen.effects import EFFECTS
from vehgen.fit.trial import load_trials
from vehgen.vehicle import load_vehicle


@pytest.fixture(scope="module")
def nothing(record):
    return record()


@pytest.fixture(scope="module")
def cubic(record):
    return record(CUBIC)


@pytest.mark.slow
def test_the_noise_floor_is_that_of_the_phones(detection_of):
    """On a measured road it is found beside the profile's error, less sharply."""
    truth = {item.run.name: list(item.sigma.values()) for item in simulate_case(Case("sedan2", runs=RUNS, seed=3))}
    floor = detection_of().floor
    assert set(floor.noises) == set(truth)
    for name, noise in floor.noises.items():
        assert noise.sigma == pytest.approx(truth[name], rel=0.25 if name == "rough" else 0.15)
    assert floor.corrected == ()


@pytest.mark.thorough
def test_nothing_hidden_is_found_to_be_nothing(trials_of):
    found = diagnose_trials(trials_of())
    assert found.verdict.verdict == "no_missing_effect"
    assert found.detection.chi < 1.06


@pytest.mark.thorough
@pytest.mark.parametrize("count", [1, 2])
def test_runs_too_few_to_check_the_fit_do_not_tell_that_nothing_is_missing(trials_of, count):
    found = diagnose_trials(trials_of(runs=HUMPS)[:count]).verdict
    assert found.verdict == "insufficient_data"
    assert f"noise (chi {found.gap.before:.3f}" in found.reason
    assert f"at least three runs are needed, one of them for checking ({count} given)" in found.reason
    assert found.next_experiment == "record at least three runs, with two hump heights or speeds"


@pytest.mark.thorough
def test_a_hidden_spring_is_placed_named_and_measured(trials_of):
    found = diagnose_trials(trials_of(CUBIC, runs=HUMPS))
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


def test_the_command_leaves_report_and_vehicle(told):
    data, folder = told
    assert data["verdict"] == "named"
    vehicle = load_vehicle(data["vehicle_file"])
    assert vehicle.values()["cubic_stiffness_rear_k3"] == pytest.approx(data["effects"][0]["parameters"]["k3"]["value"])
    page = (folder / "report.html").read_text(encoding="utf-8")
    assert page.count("<svg") >= 4
    assert "suspension rear" in page


@pytest.mark.slow
def test_a_sensor_that_reads_too_much_is_told_from_a_force(record):
    paths = record(Effect("sensor_gain", "F_az", {"error": 0.15}), runs=HUMPS)
    names = ("cubic_stiffness", "sensor_gain", "sensor_position")
    found = diagnose_trials(load_trials(paths), [EFFECTS[name] for name in names]).verdict
    assert found.verdict == "named"
    assert (found.effects[0].name, found.effects[0].place) == ("sensor_gain", "F_az")
    low, high = found.effects[0].parameters["gain"].interval
    assert low - 0.005 <= 1.15 <= high + 0.005


@pytest.mark.thorough
def test_one_run_names_nothing(cubic):
    found = diagnose_trials(load_trials(cubic[:1])).verdict
    assert found.verdict == "insufficient_data"
    assert "three runs" in found.next_experiment


def test_untouched_runs_lie_between_the_extremes(trials_of):
    training, held = split_runs(trials_of())
    assert [trial.name for trial in held] == ["low"]
    assert [trial.name for trial in training] == ["rough", "high", "fast"]


def gaps(training, validation):
    """Return what split_by_gap asks of a fit: mean squares by run, and whether there are validation runs."""
    squares = training | validation
    mean = [float(np.mean(list(part.values()))) if part else float("nan") for part in (training, validation)]
    return SimpleNamespace(training=mean[0], validation=mean[1], mean_squares=squares, validation_fit=object() if validation else None)


def test_a_validation_run_that_shows_nothing_is_changed_for_one_that_does(trials_of):
    trials = trials_of()
    training, held = split_by_gap(gaps({"rough": 1.0, "high": 9.0, "fast": 5.0}, {"low": 1.1}), trials)
    assert [trial.name for trial in held] == ["fast"]
    assert {trial.name for trial in training} == {"rough", "low", "high"}


def test_a_gap_that_a_validation_run_alone_shows_is_fitted(trials_of):
    trials = trials_of()
    training, held = split_by_gap(gaps({"rough": 1.2, "high": 1.4, "fast": 1.1}, {"low": 40.0}), trials)
    assert [trial.name for trial in held] == ["high"]
    assert {trial.name for trial in training} == {"rough", "low", "fast"}


@pytest.mark.parametrize(
    ("training", "validation"),
    [
        ({"rough": 1.0, "high": 9.0, "fast": 5.0}, {"low": 3.0}),
        ({"rough": 1.0, "high": 9.0, "fast": 1.0}, {"low": 1.1}),
        ({"rough": 1.0, "high": 1.1, "fast": 1.0}, {"low": 1.0}),
        ({"rough": 1.0, "high": 9.0}, {}),
        ({"rough": 30.0, "high": 90.0, "fast": 20.0}, {"low": 4000.0}),
    ],
    ids=["it shows enough", "one run alone shows it", "there is no gap", "nothing is held", "the others show enough"],
)
def test_validation_runs_stay(trials_of, training, validation):
    assert split_by_gap(gaps(training, validation), trials_of()) is None


def test_an_unknown_effect_is_refused_with_the_nearest_name(nothing, tmp_path, capsys):
    assert main(["diagnose", "sedan2.yaml", str(nothing[0]), "--effects", "dry_frction", "--out", str(tmp_path)]) == 2
    assert "did you mean 'dry_friction'" in capsys.readouterr().err


def test_a_copy_of_a_run_is_refused(nothing, tmp_path, capsys):
    folder = tmp_path / "runs"
    shutil.copytree(nothing[0].parent, folder)
    shutil.copy(folder / "low.yaml", folder / "twin.yaml")
    paths = [str(path) for path in folder.glob("*.yaml")]
    assert main(["diagnose", "sedan2.yaml", *paths, "--out", str(tmp_path / "out")]) == 2
    assert "hold the same recording" in capsys.readouterr().err
