"""What a base hides that has bent its parameters and the errors of its runs to a mistake of the measurement."""

import re
import shutil
import textwrap
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from benchmarks.hidden_effects.generator import Effect, Hump, RunSpec, perturbed

from tests.diagnose.conftest import CUBIC, HUMPS, edited
from vehgen.diagnose import ending
from vehgen.diagnose.decision import Decision
from vehgen.diagnose.detect.detection import detect
from vehgen.diagnose.inputs import axles, humps, judging
from vehgen.diagnose.inputs.amplitudes import silent_hypotheses
from vehgen.diagnose.inputs.axles import axle_hypotheses
from vehgen.diagnose.inputs.fault import MeasurementFault
from vehgen.diagnose.inputs.humps import exchanged_humps
from vehgen.diagnose.inputs.judging import plain_mistakes, recorded_mistakes
from vehgen.diagnose.inputs.labels import label_hypotheses
from vehgen.diagnose.inputs.refits import BaseRefits
from vehgen.fit.trial import load_trials
from vehgen.measure.acquisition import POINT_SAMPLES, AcquisitionChain
from vehgen.simulate import Simulator
from vehgen.vehicle import load_vehicle, parse_vehicle
from vehgen.vehicle.loading import bundled_models

BAND = (0.5, 25.0)
R_AZ, R_Q = 2, 3


def in_degrees(values):
    values[:, R_Q] *= 57.3
    return values


def dead(values):
    values[:, R_AZ] = 0.01 * np.random.default_rng(2).standard_normal(len(values))
    return values


def told(faults):
    return [(item.kind, len(item.runs), item.channels) for item in faults]


def test_a_unit_is_told_where_refits_do_not_tell(trials_of, monkeypatch):
    plain = trials_of(runs=HUMPS)
    monkeypatch.setattr(judging, "find_mistakes", lambda detection, plain_only: SimpleNamespace(faults=()))
    bent = SimpleNamespace(trials=edited(plain, in_degrees), band=BAND, chi=1.2)
    assert told(plain_mistakes(bent)) == [("unit", len(plain), ("R_q",))]
    assert plain_mistakes(SimpleNamespace(trials=plain, band=BAND, chi=1.2)) == ()


def test_a_dead_channel_is_told_where_the_base_hardly_moves_there(trials_of, detection_of):
    """Of one run alone it is left to the refits."""
    plain = trials_of(runs=HUMPS)
    quiet = SimpleNamespace(floor=detection_of(runs=HUMPS).floor, band=BAND, is_quiet=True, trials=edited(plain, dead))
    assert told(recorded_mistakes(quiet)) == [("dead", len(plain), ("R_az",))]
    for trials in (plain, edited(plain, dead, plain[0].name)):
        quiet.trials = trials
        assert recorded_mistakes(quiet) == ()


@pytest.mark.slow
def test_a_channel_of_which_the_others_foretell_nothing_is_silent(trials_of, detection_of):
    """Whatever the vehicle file foretells: a truck's had been too far off, and a sensor's tilt imitated its dead accelerometer."""
    case = BaseRefits(detect(edited(trials_of(runs=HUMPS), dead)))
    (found,) = silent_hypotheses(case)
    assert told(found.describe(np.zeros(0))) == [("dead", len(HUMPS), ("R_az",))]
    assert found.blind == {(run.name, "R_az") for run in HUMPS}
    assert list(silent_hypotheses(BaseRefits(detection_of(Effect("sensor_gain", "R_az", {"error": 0.3}), runs=HUMPS)))) == []


def test_a_channel_alone_is_not_left_out():
    case = SimpleNamespace(trials=[SimpleNamespace(channels=("R_az",))])
    assert list(silent_hypotheses(case)) == []


@pytest.mark.parametrize(("least", "turned"), [(-0.1, True), (0.1, False)])
def test_a_channel_that_follows_its_opposite_in_the_mean_of_runs_is_tried_as_turned(trials_of, least, turned):
    """In each run by itself it follows too little: -0.3 is asked there."""
    own = np.diag([0.6, 0.6, least, 0.6])[None]
    items = [SimpleNamespace(own=np.diagonal(own, axis1=1, axis2=2), best=0, within=lambda lag: own)] * 3
    found = list(label_hypotheses(SimpleNamespace(trials=trials_of(runs=HUMPS)[:3], comparisons=items)))
    assert [told(item.describe(np.zeros(0))) for item in found] == ([[("turned", 3, ("R_az",))]] if turned else [])


def test_a_recording_that_is_put_right_keeps_the_noise_of_the_base(detection_of):
    """What measured roads and their errors make of it is known for the base alone: by a lead-in's noise nothing would be put right."""
    case = BaseRefits(detection_of(runs=HUMPS))
    changed = edited(case.trials, in_degrees, case.trials[0].name)
    noises = case._noises(changed, frozenset())
    for trial in case.trials:
        factors = [1, 1, 1, 57.3] if trial is case.trials[0] else [1, 1, 1, 1]
        known = case.base.misfit.noises[trial.name]
        np.testing.assert_allclose(noises[trial.name].sigma, known.sigma * factors, rtol=1e-6)
        np.testing.assert_array_equal(noises[trial.name].levels, known.levels)


@pytest.mark.thorough
@pytest.mark.parametrize(("clock", "blamed"), [pytest.param(None, True, marks=pytest.mark.slow), ((1.1, 0.2), True), ((1.1, 0.0), False)])
def test_axles_are_not_blamed_where_a_clock_leaves_noise(detection_of, monkeypatch, clock, blamed):
    parameters = perturbed("sedan2", 3)
    parameters["wheelbase"] *= 1.15
    monkeypatch.setattr(axles, "other_rate", lambda case: clock)
    assert bool(list(axle_hypotheses(BaseRefits(detection_of(parameters=parameters, runs=HUMPS))))) is blamed


@pytest.mark.thorough
def test_a_distance_that_the_file_says_in_numbers_is_fitted(record, monkeypatch, tmp_path):
    """The same wheelbase as above, of which the vehicle file has no parameter: what it is is fitted, not only tried."""
    parameters = perturbed("sedan2", 3)
    parameters["wheelbase"] *= 1.15
    shutil.copytree(record(parameters=parameters, runs=HUMPS)[0].parent, tmp_path, dirs_exist_ok=True)
    numbers = re.sub(r"  wheelbase: .*\n", "", bundled_models()["sedan2"].read_text()).replace("wheelbase - Lf", "2.8 m - Lf")
    (tmp_path / "plain.yaml").write_text(numbers)
    paths = sorted(path for path in tmp_path.glob("*.yaml") if path.name != "plain.yaml")
    for path in paths:
        path.write_text(re.sub(r"vehicle: .*", "vehicle: plain.yaml", path.read_text()))
    monkeypatch.setattr(axles, "other_rate", lambda case: None)
    case = BaseRefits(detect(load_trials(paths)))
    (found,) = axle_hypotheses(case)
    fit, left = case.judge(found)
    (fault,) = found.describe(fit.misfit.adjusted(fit.x))
    (distance,) = axles._distances(case)
    later, _ = (case.judge(item)[1] for item in distance.hypotheses(case.trials, distance.value + 0.42))
    assert left < min(found.limit, 0.5 * later)  # the lever arms change, too
    assert fault.value == pytest.approx(0.15 * 2.8, abs=0.03)
    assert "rear seems to run" in fault.message
    assert "not 2.80 m" in fault.message


def test_axles_are_moved_alone_and_with_all_behind_where_no_parameter_says_where_they_run(tmp_path):
    """The hinge's distance moves both axles of the semitrailer; the numbers of the third axle and of the fourth are nobody's."""
    text = bundled_models()["tractor5"].read_text().replace("L13 - b1", "4.80 m - b1").replace("Lh4 - b6", "8.50 m - b6")
    text = re.sub(r"  (L13|Lh4): .*\n", "", text)
    text = re.sub(r"(L13|Lh4): [^,}]+(, |(?=}))", "", text)
    (tmp_path / "t.yaml").write_text(text)
    vehicle = load_vehicle(tmp_path / "t.yaml")
    road = SimpleNamespace(track=SimpleNamespace(parts=("hump",)))
    simulator = Simulator(vehicle, [])
    trial = SimpleNamespace(values=vehicle.values(), fixed=(), simulator=simulator, run=SimpleNamespace(vehicle=vehicle), scenario=road)
    trial.with_vehicle = lambda changed, simulators: SimpleNamespace(vehicle=changed)
    case = SimpleNamespace(trials=[trial], problem=SimpleNamespace(space=SimpleNamespace(names=tuple(vehicle.ranges()))))
    distances = axles._distances(case)
    found = {distance.axles: (distance.parameter, round(distance.value, 6)) for distance in distances}
    supposed = {
        distance.axles: list(distance.hypotheses(case.trials, distance.value + 0.5)) for distance in distances if not distance.parameter
    }
    assert {names: len(items) for names, items in supposed.items()} == {
        ("axle3",): 2,
        ("axle3", "axle4", "axle5"): 1,
        ("axle4",): 2,
    }
    known, moved = vehicle.all_values(vehicle.values()), supposed[("axle3",)][1].trials[0].vehicle
    assert moved.axles["axle3"].x.evaluate(known) == pytest.approx(vehicle.axles["axle3"].x.evaluate(known) - 0.5)
    assert found == {
        ("axle2",): ("L12", 3.46),
        ("axle4", "axle5"): ("L1h", 3.75),
        ("axle5",): ("Lh5", 9.73),
        ("axle3",): ("", 4.8),
        ("axle3", "axle4", "axle5"): ("", 4.8),
        ("axle4",): ("", 12.25),
    }


def test_an_axle_is_moved_where_a_searched_place_of_a_cog_takes_part_in_its_distance():
    """A caravan's axle, whose hitch stands so far behind the car's COG: a file with a wrong one was told as eleven wrong parameters."""
    text = """
        parameters: {a: {value: 1.2 m, range: [0.8 m, 1.6 m]}}
        bodies: {car: {mass: 1300 kg, pitch_inertia: 2000 kg m^2}, caravan: {mass: 1100 kg, pitch_inertia: 2000 kg m^2}}
        hinges: {ball: {car: {x: -2.6 m}, caravan: {x: 3.6 m}}}
        axles:
          front: {body: car, x: a, tyre: {k: 40 kN/m}}
          rear: {body: car, x: a - 2.7 m, tyre: {k: 40 kN/m}}
          van: {body: caravan, x: 0 m, tyre: {k: 40 kN/m}}
        """
    vehicle = parse_vehicle(textwrap.dedent(text))
    trial = SimpleNamespace(values=vehicle.values(), fixed=(), simulator=Simulator(vehicle, []), run=SimpleNamespace(vehicle=vehicle))
    trial.scenario = SimpleNamespace(track=SimpleNamespace(parts=("hump",)))
    case = SimpleNamespace(trials=[trial], problem=SimpleNamespace(space=SimpleNamespace(names=("a",))))
    found = {distance.axles: round(distance.value, 6) for distance in axles._distances(case)}
    assert found == {("rear",): 2.7, ("rear", "van"): 2.7, ("van",): 7.4}


@pytest.mark.thorough
@pytest.mark.parametrize(("dearer", "blamed"), [(30.0, False), (40.0, True)])
def test_axles_are_blamed_where_a_speed_leaves_noise_with_many_other_errors(detection_of, monkeypatch, dearer, blamed):
    """A sedan's wheelbase 0.3 m off was taken for speeds 8 % off, with gains, heights and humps four standard deviations off."""
    parameters = perturbed("sedan2", 3)
    parameters["wheelbase"] *= 1.15
    case = BaseRefits(detection_of(parameters=parameters, runs=HUMPS))
    refit, losses = case.refit, []

    def fitted(problem, shared=(), numbers=(), **options):
        fit, left = refit(problem, shared, numbers, **options)
        losses.append(fit.loss)
        return (SimpleNamespace(loss=losses[0] + dearer), 0.0) if shared else (fit, left)

    monkeypatch.setattr(case, "refit", fitted)
    monkeypatch.setattr(axles, "other_rate", lambda case: None)
    assert bool(list(axle_hypotheses(case))) is blamed


@pytest.mark.thorough
def test_another_hump_is_tried_in_every_shape(trials_of):
    """Which one is right a refit tells: where speeds are a little off, a wrong one may correlate better."""
    longer = tuple(RunSpec((Hump(0.9, item.road[0].height, item.road[0].at),), item.speed, item.duration, item.name) for item in HUMPS)
    true = {item.name: item for item in trials_of(runs=longer)}
    mixed = [replace(item, recording=true["high"].recording) if item.name == "high" else item for item in trials_of(runs=HUMPS)]
    case = BaseRefits(detect(mixed))
    found = [item.describe(np.zeros(0))[0].message for item in humps.hump_hypotheses(case)]
    assert all(
        any(f"shaped as a {shape.replace('_', ' ')}" in message and "high" in message for message in found) for shape in humps.SHAPES
    )


@pytest.mark.parametrize(("excess", "told_as_tie"), [(0.1, True), (0.2, False)])
def test_a_clock_that_leaves_noise_is_a_tie_with_the_effect_that_explains_more(excess, told_as_tie):
    """A sedan's clock that ran 10 % fast was named a speed 8 % off, which leaves chi 1.04 of 3.2."""
    fault = MeasurementFault("clock_or_speed", (), (), "the clock seems to run 9 % too fast", "check it")
    undone = judging.Undone((fault,), 0.42, True, SimpleNamespace(excess=excess))
    detection, leading = SimpleNamespace(is_quiet=False, chi=3.2), SimpleNamespace(chi=1.04)
    found = judging.explain_gap(detection, leading, vehicle=False, undone=undone)
    assert found == ((fault,) if told_as_tie else ())


def over(low, high):
    crossings = (("slow", low, 2.0, 3.5), ("fast", high, 4.0, 7.0), ("again", low, 2.5, 7.0))
    return tuple(RunSpec((Hump(0.5, height, at),), speed, 5.5, name) for name, height, speed, at in crossings)


def with_exchanged_humps(trials):
    """Return the trials with the humps of "slow" and "fast" exchanged, each where its own was."""
    own = {trial.name: trial.scenario for trial in trials}
    other = {"slow": "fast", "fast": "slow"}
    found = []
    for trial in trials:
        (hump,) = own[other.get(trial.name, trial.name)].humps
        track = replace(trial.scenario.track, parts=(replace(hump, at=trial.scenario.humps[0].at),))
        found.append(replace(trial, scenario=replace(trial.scenario, track=track)))
    return found


@pytest.mark.thorough
@pytest.mark.parametrize(("low", "high", "quiet"), [(0.030, 0.034, True), (0.026, 0.035, False)])
def test_exchanged_humps_are_told_whether_or_not_the_base_bends_far_enough(trials_of, low, high, quiet):
    """Heights 12 % off, the most that a run may err by, had explained a sedan's: nothing was said to be missing."""
    found = detect(with_exchanged_humps(trials_of(runs=over(low, high))))
    assert found.is_quiet == quiet
    (fault,) = exchanged_humps(found)
    assert (fault.kind, set(fault.runs)) == ("exchanged_heights", {"slow", "fast"})


@pytest.mark.parametrize(("fall", "left", "is_told"), [(50.0, 0.05, True), (30.0, 0.05, False), (3000.0, 0.2, False)])
def test_an_exchange_that_leaves_more_than_noise_or_gains_little_is_not_told(trials_of, monkeypatch, fall, left, is_told):
    """Over humps of nearly one height an exchange took 3279 off -2 ln L beside a stiffening spring, and left as much of the gap."""
    trials = trials_of(runs=over(0.030, 0.034))
    refit = {True: (SimpleNamespace(loss=0.0), 1.0), False: (SimpleNamespace(loss=-fall), left)}
    problem = SimpleNamespace(with_trials=lambda changed: "exchanged")
    case = SimpleNamespace(trials=trials, problem=problem, noise=0.1, refit=lambda tried: refit[tried is problem])
    monkeypatch.setattr(humps, "base_refits", lambda detection: case)
    heights = [SimpleNamespace(run=run, name="height", sigmas=sigmas) for run, sigmas in (("slow", 2.1), ("fast", -2.1), ("again", 0.0))]
    base = SimpleNamespace(parts=[SimpleNamespace(conditions=lambda: heights)])
    assert bool(exchanged_humps(SimpleNamespace(base=base, trials=trials))) is is_told


def test_humps_as_stated_are_not_exchanged(detection_of):
    assert exchanged_humps(detection_of(runs=over(0.030, 0.034))) == ()


@pytest.mark.thorough
@pytest.mark.parametrize(
    ("kinds", "reason", "told"), [(("low_pass",), "", True), (("low_pass", "hump_form"), "", False), (("low_pass",), "imitates", False)]
)
def test_a_slow_recorder_is_told_where_it_is_all_that_is_supposed_and_no_effect_does_as_much(
    monkeypatch, detection_of, kinds, reason, told
):
    """A truck's 8 Hz low-pass was found at 7.8 Hz, but what it makes of the noise left chi 1.27."""
    faults = tuple(MeasurementFault(kind, (), (), f"the {kind} is another", "measure it") for kind in kinds)
    monkeypatch.setattr(ending, "supposed_mistakes", lambda detection: faults)
    decision = Decision(detection_of(CUBIC, runs=HUMPS), [], False, lambda *_: None)
    found = decision._unknown(SimpleNamespace(fits=(), passed=(), idle=()), reason).verdict
    assert (found.verdict, found.faults) == (("measurement_fault", faults) if told else ("not_in_library", ()))


@pytest.mark.thorough
@pytest.mark.parametrize("chain", [POINT_SAMPLES, AcquisitionChain("bessel", 2, 15.0)], ids=["point samples", "a low-pass"])
def test_a_declared_low_pass_is_doubted_where_nothing_explains_the_runs(detection_of, chain):
    """Behind 15 Hz where the recorder had 45, a healthy sedan ended without a word of the recorder."""
    detection = detection_of(CUBIC, runs=HUMPS)
    trials = [
        replace(item, scenario=replace(item.scenario, chains=dict.fromkeys(item.channels, chain))) for item in detection.problem.trials
    ]
    declared = replace(detection, problem=detection.problem.with_trials(trials), validation_runs=(), recorder=None)
    found = Decision(declared, [], False, lambda *_: None)._unknown(SimpleNamespace(fits=(), passed=(), idle=())).verdict
    assert any("`acquisition`" in note for note in found.notes) == (chain != POINT_SAMPLES)


@pytest.mark.slow
def test_another_hump_is_found_by_refits_where_correlations_may_not_tell(trials_of):
    """Over the true hump, a trapezoid of 0.6 times the length, a truck's run was foretold with 0.62, over the file's with 0.66."""
    trials = [humps._over(trial, "trapezoid", 1.6) if trial.name == "high" else trial for trial in trials_of(runs=HUMPS)]
    case = BaseRefits(detect(trials))
    case.odd = "high"
    judged = [(case.judge(item)[1], item) for item in humps.odd_hump_hypotheses(case)]
    left, best = min(judged, key=lambda item: item[0])
    (fault,) = best.describe(np.zeros(0))
    assert (fault.kind, fault.runs, len(judged)) == ("hump", ("high",), 15)
    assert left < 0.01
    assert "half sine" in fault.message
    assert fault.value == pytest.approx(0.5, rel=0.12)
    assert humps.odd_hump_hypotheses in judging.SUBTLE
    case.odd = ""
    assert list(humps.odd_hump_hypotheses(case)) == []
