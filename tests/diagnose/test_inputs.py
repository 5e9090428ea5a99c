"""Mistakes in recordings and vehicle files, made on purpose with the independent generator, are found; honest effects are none."""

import re
from dataclasses import replace

import numpy as np
import pytest
from benchmarks.hidden_effects.generator import Effect, Hump, RunSpec, nominal, perturbed

from tests.diagnose.conftest import edited
from vehgen.diagnose.inputs.checks import check_inputs, variety_notes
from vehgen.diagnose.inputs.comparison import compare
from vehgen.diagnose.inputs.exchanges import exchanged
from vehgen.diagnose.inputs.judging import explain_gap
from vehgen.diagnose.pipeline import detect, split_runs

RUNS = (
    RunSpec((Hump(0.5, 0.03, 4.0),), 2.0, 5.0, "low"),
    RunSpec((Hump(0.5, 0.05, 4.0),), 2.5, 4.5, "high"),
    RunSpec((Hump(0.5, 0.05, 5.0),), 4.0, 4.0, "fast"),
)
NAMES = ("F_az", "F_q", "R_az", "R_q")


FRICTION = Effect("dry_friction", "front", {"force": 1100.0})


@pytest.fixture(scope="module")
def plain(trials_of):
    return trials_of(runs=RUNS)


def exchange(values):
    return values[:, [2, 3, 0, 1]]


def turn(*names):
    return lambda values: values * np.array([-1.0 if name in names else 1.0 for name in NAMES])


def test_good_recordings_leave_nothing_to_say(plain):
    assert check_inputs(plain) == ()
    assert variety_notes(plain) == ()


def test_a_quantised_or_noiseless_recording_is_not_clipped_and_not_stuck(plain):
    assert check_inputs(edited(plain, lambda values: np.round(values / 0.05) * 0.05)) == ()
    silent = edited(plain, lambda values: np.where(np.arange(len(values))[:, None] < 100, 0.0, values))
    assert check_inputs(silent) == ()


@pytest.mark.parametrize("both", [True, False])
def test_a_clipped_accelerometer_is_found_with_level_and_share(plain, both):
    truth = next(trial for trial in plain if trial.name == "high").recording.values[:, 0]
    level = 0.5 * truth.max()

    def clip(values):
        values[:, 0] = np.clip(values[:, 0], -level if both else None, level)
        return values

    (finding,) = check_inputs(edited(plain, clip, only="high"))
    assert (finding.kind, finding.runs, finding.channels) == ("clipped", ("high",), ("F_az",))
    count = (truth >= level).sum() + both * (truth <= -level).sum()
    assert f"{level:.4g}" in finding.message
    assert f"in {count} samples ({100 * count / len(truth):.2g} %)" in finding.message


def test_a_channel_that_stays_while_the_others_move_is_stuck(plain):
    def hold(values):
        start = int(np.abs(values[:, 0]).argmax())
        values[start : start + 40, 3] = values[start, 3]
        return values

    (finding,) = check_inputs(edited(plain, hold, only="fast"))
    assert (finding.kind, finding.runs, finding.channels) == ("stuck", ("fast",), ("R_q",))
    assert "for 0.4 s" in finding.message


def test_one_height_or_speed_only_is_noted(plain):
    by_name = {trial.name: trial for trial in plain}
    (note,) = variety_notes([by_name["high"], by_name["fast"]])
    assert "one height of road" in note
    assert [("one speed" in note) for note in variety_notes([by_name["high"]])] == [False, True]


def test_correlation_is_that_of_numpy_at_the_lag_of_a_delayed_copy(plain):
    trial = plain[0]
    moved = np.roll(trial.recording.values, -7, axis=0)
    found = compare(trial, moved, (0.0, 50.0))
    middle = len(found.correlation) // 2
    assert found.correlation[:, 0, 0].argmax() == middle + 7
    assert found.lag == pytest.approx(7 * trial.recording.dt, abs=0.002)
    assert found.correlation[middle] == pytest.approx(
        trial.recording.values.T @ moved / np.outer(*(np.linalg.norm(item, axis=0) for item in (trial.recording.values, moved))),
        abs=1e-9,
    )


def test_recordings_change_places_with_the_samples_that_are_not_kept(plain):
    one, other = plain[0], replace(plain[1], scenario=replace(plain[1].scenario, skipped=7))
    again = exchanged(one, other, "recording")
    assert again.recording is other.recording
    assert again.scenario.skipped == 7
    assert again.scenario.track is one.scenario.track


@pytest.mark.slow
def test_exchanged_phones_are_named(plain):
    (finding,) = explain_gap(detect(edited(plain, exchange)))
    assert (finding.kind, set(finding.runs), finding.channels) == ("exchanged", {"low", "high", "fast"}, ("F", "R"))
    assert "F and R have been exchanged in all runs" in finding.message


@pytest.mark.thorough
def test_phones_exchanged_in_an_untouched_run_only_are_named_with_the_run(plain):
    untouched = split_runs(plain)[1][0].name
    (finding,) = explain_gap(detect(edited(plain, exchange, only=untouched)))
    assert (finding.kind, finding.runs) == ("exchanged", (untouched,))


@pytest.mark.slow
def test_a_turned_axis_is_named_though_friction_hides_too(trials_of):
    (finding,) = explain_gap(detect(edited(trials_of(FRICTION, runs=RUNS), turn("F_az"))))
    assert (finding.kind, len(finding.runs), finding.channels) == ("turned", 3, ("F_az",))
    assert "sign: -1" in finding.cure


@pytest.mark.slow
def test_a_wrong_wheelbase_is_measured_by_the_arrival_of_the_rear_axle(detection_of):
    parameters = perturbed("sedan2", 3)
    parameters["wheelbase"] *= 1.15
    (finding,) = explain_gap(detection_of(parameters=parameters, runs=RUNS))
    assert finding.kind == "axle_position"
    assert "rear seems to run" in finding.message
    assert finding.value == pytest.approx(0.15 * nominal("sedan2")["wheelbase"], abs=0.02)


@pytest.mark.slow
def test_another_vehicle_is_told_by_its_parameters(detection_of):
    parameters = perturbed("sedan2", 3)
    for name in ("kf", "kr"):
        parameters[name] = 2 * nominal("sedan2")[name]
    (finding,) = explain_gap(detection_of(parameters=parameters, runs=RUNS))
    assert finding.kind == "other_parameters"
    ratios = dict(re.findall(r"(\w+) (\S+) times", finding.message))
    assert {name: float(ratio) for name, ratio in ratios.items()} == pytest.approx({"kf": 2.0, "kr": 2.0}, rel=0.02)
    assert "something unknown" in finding.message, "one or two parameters may stand for it"


def test_recordings_that_have_nothing_to_do_with_the_vehicle_are_refused(plain):
    random = np.random.default_rng(1)
    (finding,) = explain_gap(
        detect(edited(plain, lambda values: values + 5 * np.std(values, axis=0) * random.standard_normal(values.shape)))
    )
    assert finding.kind == "stranger"


@pytest.mark.thorough
@pytest.mark.parametrize(
    "effect",
    [
        pytest.param(FRICTION, id="dry_friction", marks=pytest.mark.slow),
        pytest.param(Effect("sensor_delay", "R", {"time": 0.03}), id="sensor_delay"),
    ],
)
def test_an_effect_is_no_mistake(detection_of, effect):
    detection = detection_of(effect, runs=RUNS)
    assert check_inputs(detection.trials) == ()
    assert explain_gap(detection) == ()
