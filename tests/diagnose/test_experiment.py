"""What to measure next: proposals are kept to what an independent generator then records."""

from dataclasses import replace

import numpy as np
import pytest
from benchmarks.hidden_effects.generator import Case, Effect, Hump, Noise, RunSpec, simulate_case, write_case

from vehgen.diagnose.design import candidate_runs, experiment
from vehgen.diagnose.design.candidate_runs import free_places, list_runs
from vehgen.diagnose.design.discrimination import FittedModel, at_most, separate
from vehgen.diagnose.design.experiment import propose, propose_stronger
from vehgen.diagnose.detect.detection import detect
from vehgen.diagnose.fits.candidate import list_candidates
from vehgen.diagnose.select.search import fit_candidates
from vehgen.effects import library
from vehgen.fit.trial import load_trials, make_trial
from vehgen.mechanics import Place
from vehgen.mechanics.outputs import ElementOutput, PointOutput
from vehgen.simulate import Simulator, load_run

LOW = ((0.02, 2.0), (0.03, 2.5), (0.03, 4.0))
TRUTH = Effect("cubic_stiffness", "rear", {"k3": 3e7})
LOUD = Noise(0.1, 0.005, 0.05)


def record(folder, tmp_path_factory, humps):
    runs = tuple(RunSpec((Hump(0.5, height, 1.5 * speed),), speed, 5.0, f"run{i}") for i, (height, speed) in enumerate(humps))
    write_case(Case("sedan2", effects=(TRUTH,), runs=runs, seed=3, noise=LOUD), folder, tmp_path_factory.mktemp("truth"))
    return load_trials(sorted(folder.glob("*.yaml")))


def fit(trials):
    effects = library()
    detection = detect(trials)
    listed = list_candidates(trials[0].run.vehicle, trials, [effects["cubic_stiffness"], effects["bump_stop"]])
    rear = [item for item in listed if item.place == "rear"]
    return detection, fit_candidates(detection, detection.base, [], rear, lambda *_: None)[0]


@pytest.fixture(scope="module")
def tied(tmp_path_factory):
    return fit(record(tmp_path_factory.mktemp("low"), tmp_path_factory, LOW))


@pytest.fixture(scope="module")
def proposal(tied):
    return propose(*tied)


def lead(fits):
    """Return how much less of chi-squared the true law leaves than the wrong one, on the runs of the fit."""
    left = {item.last.effect.name: item for item in fits}
    names = [trial.name for trial in fits[0].least_squares.misfit.problem.trials]
    total = {law: sum(item.mean_squares[run] * item.counts[run] for run in names) for law, item in left.items()}
    return total["bump_stop"] - total["cubic_stiffness"]


@pytest.mark.thorough
def test_laws_that_low_humps_cannot_tell_apart_want_a_higher_one(tied, proposal):
    assert abs(lead(tied[1])) < 9
    assert proposal.separates
    assert proposal.height > 0.03
    assert proposal.distance > 25
    assert proposal.added is None
    assert proposal.text.startswith(f"drive over the same hump, {proposal.height:.3g} m high, at {proposal.speed:.3g} m/s: the predictions")
    assert proposal.to_dict()["models"] == ["cubic_stiffness at rear", "bump_stop at rear"]


@pytest.mark.slow
def test_the_proposed_run_keeps_what_was_promised(tied, proposal, tmp_path_factory):
    _, fits = fit(record(tmp_path_factory.mktemp("more"), tmp_path_factory, (*LOW, (proposal.height, proposal.speed))))
    assert "run3" in fits[0].mean_squares
    assert lead(fits) - lead(tied[1]) == pytest.approx(proposal.distance, rel=0.5)
    assert lead(fits) > 25


@pytest.mark.thorough
def test_predictions_are_those_of_the_generator(tied):
    detection, fits = tied
    true = next(item for item in fits if item.last.effect.name == "cubic_stiffness")
    rival = FittedModel.of(true, detection.problem.trials[0].channels)
    run = list_runs(detection.problem.trials)[-3]
    values = dict(zip(true.least_squares.misfit.problem.space.names, true.least_squares.values, strict=True))
    k3 = values.pop("cubic_stiffness_rear_k3")
    at = run.scenario.track.parts[0].at
    parameters = {"mH": 1500.0, "wheelbase": 2.8, **values}
    parameters["Lr"] = 2.8 - parameters["Lf"]
    spec = RunSpec((Hump(0.5, run.height, at),), run.speed, run.scenario.duration, "new")
    case = Case("sedan2", parameters, (Effect("cubic_stiffness", "rear", {"k3": k3}),), (spec,))
    (recorded,) = simulate_case(case)
    predicted = rival.predict(run)
    for column, channel in enumerate(rival.trial.channels):
        clean = recorded.clean[channel][: len(predicted)]
        assert predicted[: len(clean), column] == pytest.approx(clean, abs=0.03 * np.abs(clean).max())


@pytest.mark.thorough
def test_no_refit_can_exceed_the_quick_bound(tied):
    detection, fits = tied
    channels = detection.problem.trials[0].channels
    one, other = (FittedModel.of(item, channels) for item in fits)
    for run in list_runs(detection.problem.trials)[2::5]:
        assert 0 <= separate(one, other, run, channels).distance <= at_most(one, other, run, channels).distance
        assert separate(one, other, run, channels[:1]).distance <= separate(one, other, run, channels).distance + 1e-6


def test_an_effect_too_weak_to_name_stands_out_in_a_stronger_run(tied):
    detection, fits = tied
    found = propose_stronger(detection, next(item for item in fits if item.last.effect.name == "cubic_stiffness"))
    assert found.separates
    assert found.height > 0.03
    assert "leave the base model at chi 1." in found.text


def test_equal_models_are_said_to_be_equal(tied):
    detection, fits = tied
    found = propose(detection, [fits[0], replace(fits[0])])
    assert not found.separates
    assert found.height is None
    assert "nothing that can be measured" in found.text
    assert propose(detection, fits[:1]) is None


def test_where_no_run_is_enough_the_best_is_named_with_the_repeats_it_takes(tied, monkeypatch):
    monkeypatch.setattr(experiment, "ENOUGH_CHI2", 5e3)
    monkeypatch.setattr(experiment, "REPEATS", 100)
    monkeypatch.setattr(candidate_runs, "HEIGHTS", (0.5, 1.0))
    found = propose(*tied)
    assert not found.separates
    assert found.height <= 0.03
    assert "such runs to be sure" in found.text or "too little to be sure" in found.text


def test_added_channels_are_simulated_beside_the_old_ones(tied):
    detection, fits = tied
    trial = detection.problem.trials[0]
    rival = FittedModel.of(fits[0], trial.channels)
    run = list_runs(detection.problem.trials)[0]
    quarter = PointOutput("quarter", Place("quarter", "body", behind="front", distance=0.7), "acceleration")
    more = rival.with_outputs([quarter])
    assert more.predict(run)[:, :-1] == pytest.approx(rival.predict(run), abs=1e-9)
    assert more.noise.sigma[-1] == pytest.approx(rival.noise.sigma[[0, 2]].mean())
    front, rear = rival.predict(run)[:, 0], rival.predict(run)[:, 2]
    between = 0.75 * front + 0.25 * rear
    assert more.predict(run)[:, -1] == pytest.approx(between, abs=0.03 * np.abs(between).max())
    travel = rival.travels(run, ["rear"])[:, 0]
    vehicle = rival.trial.run.vehicle
    simulator = Simulator(vehicle, [ElementOutput("travel", "rear", "suspension_travel")])
    values = dict(zip(fits[0].least_squares.misfit.problem.space.names, fits[0].least_squares.values, strict=True))
    alone = simulator.run(simulator.parameters(values), run.scenario).responses[0, :, 0]
    assert travel == pytest.approx(alone, abs=1e-9)


@pytest.mark.slow
def test_a_sensor_is_added_where_those_there_do_not_suffice(tied, monkeypatch):
    quarter = PointOutput("quarter", Place("quarter", "body", behind="front", distance=0.7), "acceleration")
    monkeypatch.setattr(experiment, "free_places", lambda trial: [quarter])
    monkeypatch.setattr(experiment, "ENOUGH_CHI2", 5e3)
    monkeypatch.setattr(experiment, "WORTH", 0.5)
    found = propose(*tied)
    assert found.added == "an accelerometer on body at front"
    assert found.text.startswith("add an accelerometer on body at front and drive over the same hump")
    monkeypatch.setattr(experiment, "WORTH", 1e3)
    assert propose(*tied).added is None


TRACTOR = """vehicle: tractor5.yaml
speed: 2.5 m/s
road: [{hump: {shape: versine, length: 0.4 m, height: 0.05 m, at: 2 m}}]
sensors: {L1: {body: tractor, behind: axle1, distance: -0.29 m, channels: {acceleration: L1_az}}}
recording: nothing.csv
"""


def test_sensors_are_added_where_a_body_has_none(tmp_path):
    (tmp_path / "run.yaml").write_text(TRACTOR, encoding="utf-8")
    noise = np.random.default_rng(0).standard_normal(901)
    np.savetxt(tmp_path / "nothing.csv", np.column_stack([np.arange(901) * 0.01, noise]), delimiter=",", header="t,L1_az", comments="")
    trial = make_trial(load_run(tmp_path / "run.yaml"), "run")
    found = {(item.place.body, item.place.behind, item.quantity) for item in free_places(trial)}
    assert found == {
        ("tractor", "axle3", "acceleration"),
        ("tractor", "axle1", "pitch_rate"),
        ("semitrailer", "fifth_wheel", "acceleration"),
        ("semitrailer", "axle5", "acceleration"),
        ("semitrailer", "fifth_wheel", "pitch_rate"),
    }
    runs = list_runs([trial])
    assert [run.height for run in runs[:: len(runs) // 4]] == [0.025, 0.05, 0.075, 0.1]
    assert sorted({run.speed for run in runs}) == [1.5, 2.5, 3.8, 5.0]
    assert all(run.length == 0.4 for run in runs)
    high = runs[-1].scenario.track
    assert high.height(np.linspace(0, 20, 200001)).max() == pytest.approx(0.1, rel=1e-6)
