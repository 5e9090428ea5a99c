"""Plain mistakes made on purpose in recordings and run files are named with run, channel and cure; healthy runs and effects are not."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
import scipy.interpolate
import scipy.signal
from benchmarks.hidden_effects.generator import Effect, Hump, RunSpec, nominal, perturbed

from tests.diagnose.conftest import edited
from vehgen.diagnose.detect.detection import detect
from vehgen.diagnose.inputs.amplitudes import dead_hypotheses, hidden_mistakes, unit_hypotheses
from vehgen.diagnose.inputs.conditions import alike_in_all_runs, findings_of_conditions, moved_roads
from vehgen.diagnose.inputs.judging import explain_gap, plain_mistakes, recorded_mistakes, supposed_mistakes
from vehgen.diagnose.inputs.recorders import slow_recorder
from vehgen.diagnose.inputs.refits import BaseRefits
from vehgen.diagnose.inputs.vehicle import strange_run_hypotheses
from vehgen.diagnose.pipeline import diagnose_trials
from vehgen.diagnose.thresholds import NOISE_FLOOR
from vehgen.fit.chain_estimate import ChainEstimate
from vehgen.fit.chain_losses import ChainFit
from vehgen.fit.nuisances import Condition
from vehgen.fit.recorders import FoundRecorder
from vehgen.measure.acquisition import AcquisitionChain

RUNS = (
    RunSpec((Hump(0.5, 0.03, 4.0),), 2.0, 5.0, "low"),
    RunSpec((Hump(0.5, 0.05, 4.0),), 2.5, 4.5, "high"),
    RunSpec((Hump(0.5, 0.05, 5.0),), 4.0, 4.0, "fast"),
)
F_AZ, F_Q, R_AZ, R_Q = range(4)


@pytest.fixture(scope="module")
def plain(trials_of):
    return trials_of(runs=RUNS)


def times(factor, *channels):
    return lambda values: values * np.array([factor if i in channels else 1.0 for i in range(4)])


def noise_only(channel, sigma):
    def change(values):
        values[:, channel] = sigma * np.random.default_rng(2).standard_normal(len(values))
        return values

    return change


def rear_later(samples):
    """Return a change that shifts the rear sensor, and leaves noise where it has nothing to show."""

    def change(values):
        quiet = np.array([0.015, 0.0006]) * np.random.default_rng(3).standard_normal((len(values), 2))
        if samples > 0:
            quiet[samples:] = values[:-samples, 2:]
        else:
            quiet[:samples] = values[-samples:, 2:]
        return np.column_stack([values[:, :2], quiet])

    return change


def low_passed(cutoff):
    sections = scipy.signal.butter(4, cutoff, fs=100.0, output="sos")
    return lambda values: scipy.signal.sosfilt(sections, values, axis=0)


def stated(trials, run, **changes):
    """Return trials of which one states another scenario: its speed or its road's height times a factor."""
    return [replace(trial, scenario=trial.scenario.adjusted(**changes)) if trial.name == run else trial for trial in trials]


def exchanged(trials, one, other, field):
    """Return trials of which two have exchanged their speed or their track, as two run files may."""
    scenario = {trial.name: trial.scenario for trial in trials}
    swap = {one: other, other: one}
    return [
        replace(trial, scenario=replace(trial.scenario, **{field: getattr(scenario[swap[trial.name]], field)}))
        if trial.name in swap
        else trial
        for trial in trials
    ]


def over_another_hump(trials, length):
    """Return trials whose files state a hump of another length, about the same middle."""
    changed = []
    for trial in trials:
        track = trial.scenario.track
        hump = track.parts[0]
        peak = float(hump.shape(np.array([hump.length / 2]))[0])
        other = type(hump).from_shape("half_sine", hump.at + (hump.length - length) / 2, length, peak)
        changed.append(replace(trial, scenario=replace(trial.scenario, track=replace(track, parts=(other,)))))
    return changed


def told(faults):
    return [(item.kind, set(item.runs), item.channels) for item in faults]


EVERY = {"low", "high", "fast"}
PLAIN_CASES = {
    "g for m/s^2 in one run": (lambda runs: edited(runs, times(1 / 9.81, F_AZ), "high"), ("unit", {"high"}, ("F_az",)), 1 / 9.81),
    "deg/s in all runs": (lambda runs: edited(runs, times(57.3, R_Q)), ("unit", EVERY, ("R_q",)), 57.3),
    "dead in one run": (lambda runs: edited(runs, noise_only(R_AZ, 0.01), "high"), ("dead", {"high"}, ("R_az",)), None),
    "turned in one run": (lambda runs: edited(runs, times(-1, F_AZ), "fast"), ("turned", {"fast"}, ("F_az",)), None),
    "clocks 1.5 s apart": (lambda runs: edited(runs, rear_later(150), "low"), ("clocks_apart", {"low"}, ("R",)), 1.5),
    "clocks 0.1 s apart": (lambda runs: edited(runs, rear_later(10), "low"), ("clocks_apart", {"low"}, ("R",)), 0.1),
    "speeds exchanged": (lambda runs: exchanged(runs, "low", "fast", "speed"), ("exchanged_speeds", {"low", "fast"}, ()), None),
    "km/h as m/s": (lambda runs: stated(runs, "high", speed=3.6), ("speed_unit", {"high"}, ()), 1 / 3.6),
    "acceleration and rate exchanged": (
        lambda runs: edited(runs, lambda values: values[:, [F_Q, F_AZ, R_AZ, R_Q]]),
        ("exchanged", EVERY, ("F_az", "F_q")),
        None,
    ),
}
QUICK_CASES = {"g for m/s^2 in one run", "turned in one run", "speeds exchanged"}


@pytest.mark.thorough
@pytest.mark.parametrize("case", [case if case in QUICK_CASES else pytest.param(case, marks=pytest.mark.thorough) for case in PLAIN_CASES])
def test_a_plain_mistake_is_named_before_any_effect_is_looked_for(plain, case):
    make, expected, value = PLAIN_CASES[case]
    (fault,) = plain_mistakes(detect(make(plain)))
    assert told([fault]) == [expected]
    within = 0.05 if case == "clocks 0.1 s apart" else 0.02  # half a sample
    assert value is None or fault.value == pytest.approx(value, rel=within)
    assert fault.cure


@pytest.mark.thorough
def test_a_unit_is_told_where_nothing_seems_to_be_missing(plain):
    """As where a loud lead-in makes noise of it."""
    found = detect(edited(plain, times(57.3, R_Q)))
    quiet = SimpleNamespace(trials=found.trials, floor=found.floor, band=found.band, is_quiet=True)
    (fault,) = recorded_mistakes(quiet)
    assert told([fault]) == [("unit", EVERY, ("R_q",))]
    assert fault.value == pytest.approx(57.3, rel=0.01)


def test_a_unit_in_one_run_alone_is_left_to_the_refits(plain):
    assert hidden_mistakes(edited(plain, times(57.3, R_Q), "high"), (0.5, 25.0)) == ()


def test_a_unit_holds_in_runs_that_hardly_follow_their_prediction(plain):
    runs = edited(plain, times(1 / 9.81, R_AZ))
    levels = np.array([0.1, -0.1, -np.log(9.81), 0.0])
    follow = [SimpleNamespace(levels=levels, own=np.full((1, 4), own), best=0) for own in (0.9, 0.9, 0.2)]
    case = SimpleNamespace(trials=runs, comparisons=follow, runs=tuple(trial.name for trial in runs))
    (hypothesis,) = unit_hypotheses(case)
    for found, trial in zip(hypothesis.trials, plain, strict=True):
        np.testing.assert_allclose(found.recording.values, trial.recording.values, rtol=1e-3)


def test_a_unit_is_told_of_a_channel_on_a_road_that_raises_all_channels(plain):
    """A run over a low hump, 1.8 times as loud as predicted: by itself its channel is 103 times too loud, which no unit makes."""
    doubled = edited(edited(plain, times(57.3, R_Q)), times(1.8, *range(4)), "low")
    (fault,) = hidden_mistakes(doubled, (0.5, 25.0))
    assert told([fault]) == [("unit", EVERY, ("R_q",))]


@pytest.mark.parametrize("loud", [1.0, 20.0], ids=["even", "loud for a moment"])
def test_a_channel_is_dead_only_if_it_is_as_loud_all_the_time(plain, loud):
    """Whatever it follows: a clock that is off, and a missing effect, spoil its prediction."""

    def change(values):
        values = noise_only(R_AZ, 0.01)(values)
        values[100:150, R_AZ] *= loud
        return values

    runs = edited(plain, change, "high")
    unlike = np.array([[0.9, 0.9, 0.1, 0.9]])
    follow = [SimpleNamespace(own=np.where(trial.name == "high", unlike, 0.9), best=0, dt=0.01) for trial in runs]
    found = list(dead_hypotheses(SimpleNamespace(trials=runs, comparisons=follow, runs=tuple(trial.name for trial in runs))))
    assert [hypothesis.blind for hypothesis in found] == ([frozenset({("high", "R_az")})] if loud == 1.0 else [])


@pytest.mark.slow
def test_two_mistakes_are_both_named(plain):
    runs = edited(edited(plain, lambda values: values[:, [2, 3, 0, 1]], "low"), times(57.3, R_Q))
    assert {item.kind for item in plain_mistakes(detect(runs))} == {"exchanged", "unit"}


SUBTLE_CASES = {
    "8 Hz low-pass in one channel": (
        lambda runs: edited(runs, lambda v: np.column_stack([low_passed(8)(v[:, 0]), v[:, 1:]])),
        "low_pass",
        8,
    ),
    "gain 1.25 in one run": (lambda runs: edited(runs, times(1.25, F_AZ), "high"), "gain", 1.25),
    "another hump": (lambda runs: over_another_hump(runs, 0.38), "hump", 0.5),
}


@pytest.mark.slow
@pytest.mark.parametrize("case", SUBTLE_CASES)
def test_a_mistake_that_looks_like_an_effect_explains_the_gap_with_its_number(plain, case):
    make, kind, value = SUBTLE_CASES[case]
    detection = detect(make(plain))
    assert plain_mistakes(detection) == ()
    faults = explain_gap(detection)
    assert {item.kind for item in faults} == {kind}
    assert faults[0].value == pytest.approx(value, rel=0.05)


@pytest.mark.slow
def test_a_filter_of_all_channels_is_told_though_one_of_them_is_mostly_noise(plain):
    def change(values):
        values = low_passed(8)(values)
        values[:, F_Q] += 0.4 * np.std(values[:, F_Q]) * np.random.default_rng(5).standard_normal(len(values))
        return values

    (fault,) = explain_gap(detect(edited(plain, change)))
    assert told([fault]) == [("low_pass", EVERY, ("F_az", "F_q", "R_az", "R_q"))]
    assert fault.value == pytest.approx(8, rel=0.1)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("make", "kind", "runs", "value"),
    [
        (lambda runs: stated(runs, "high", speed=1.1), "speed", {"high"}, 1 / 1.1),
        (lambda runs: edited(runs, lambda values: 1.25 * values, "fast"), "hump_height", {"fast"}, 0.25),
        (lambda runs: exchanged(runs, "low", "high", "track"), "exchanged_heights", {"low", "high"}, None),
    ],
    ids=["speed", "gain of a run", "heights"],
)
def test_what_no_careful_measurement_does_is_no_missing_effect(plain, make, kind, runs, value):
    detection = detect(make(plain))
    assert detection.chi > NOISE_FLOOR, "errors within four standard deviations would hide it"
    (fault,) = explain_gap(detection)
    assert (fault.kind, set(fault.runs)) == (kind, runs)
    assert value is None or fault.value == pytest.approx(value, abs=0.01)


@pytest.fixture(scope="module")
def mixed(trials_of, plain):
    """Three runs; the one named high is of another vehicle."""
    other = dict(zip(("mH", "IZ", "kf", "kr"), (1.35, 1.35, 1.2, 0.8), strict=True))
    parameters = {name: factor * nominal("sedan2")[name] for name, factor in other.items()}
    (strange,) = [trial for trial in trials_of(runs=RUNS, parameters=perturbed("sedan2", 3) | parameters) if trial.name == "high"]
    return detect([strange if trial.name == "high" else trial for trial in plain])


@pytest.mark.slow
def test_a_run_of_another_vehicle_is_told_from_the_others(mixed):
    (fault,) = explain_gap(mixed)
    assert (fault.kind, fault.runs) == ("other_vehicle", ("high",))


@pytest.mark.thorough
@pytest.mark.parametrize("lost", [1, 2], ids=["from what fits all runs", "from others"])
def test_a_run_of_another_vehicle_is_fitted_from_several_starts(mixed, monkeypatch, lost):
    """From the file's values, and from those that fit all runs, a fit may end far off: that alone is no reason."""
    case = BaseRefits(mixed)
    refit, own = case.refit, []

    def lost_at_first(problem, *known, unit=None, **options):
        fit, left = refit(problem, *known, unit=unit, **options)
        own.extend([1] * (unit is not None))
        return fit, 10.0 if unit is not None and len(own) <= lost else left

    monkeypatch.setattr(case, "refit", lost_at_first)
    assert next(strange_run_hypotheses(case)).blind >= {("high", "F_az")}
    assert len(own) > lost


@pytest.mark.slow
def test_a_clock_that_runs_fast_is_told_or_tied_with_the_speed(plain):
    def by_a_fast_clock(values):
        numbers = np.arange(len(values))
        return scipy.interpolate.CubicSpline(numbers, values, axis=0)(numbers / 1.1)

    (fault,) = explain_gap(detect(edited(plain, by_a_fast_clock)))
    assert fault.kind in ("clock_rate", "clock_or_speed")
    assert fault.value == pytest.approx(1.1, abs=0.01)


def test_a_recorder_that_hides_wheel_hop_is_told_where_it_is_clear():
    def found(cut_off, is_clear):
        best = ChainFit(AcquisitionChain("butterworth", 4, cut_off), 0.0)
        return FoundRecorder(ChainEstimate(best, (), 1.0, is_clear), (0.5, 40.0), False, ("F_az", "F_q"))

    (fault,) = slow_recorder(found(15.0, True), ("low", "high"))
    assert (fault.kind, fault.runs, fault.channels, fault.value) == ("low_pass", ("low", "high"), ("F_az", "F_q"), 15.0)
    sensors = replace(found(40.0, True), apart=((("F_az",), found(15.0, True).estimate), (("R_az",), found(40.0, True).estimate)))
    (fault,) = slow_recorder(sensors, ("low", "high"))
    assert (fault.channels, fault.value) == (("F_az",), 15.0)
    assert slow_recorder(found(15.0, False), ("low",)) == slow_recorder(found(40.0, True), ("low",)) == slow_recorder(None, ()) == ()


def test_a_road_that_begins_elsewhere_is_told_where_all_other_runs_agree():
    delays = {"low": 0.004, "high": -0.003, "road": 0.101}
    conditions = [Condition(run, "delay", "", value, "s", 0.2) for run, value in delays.items()]
    arrivals = dict.fromkeys(delays, 3.0)
    (fault,) = moved_roads(conditions, {"road": 10.0}, arrivals)
    assert (fault.kind, fault.runs) == ("road_position", ("road",))
    assert fault.value == pytest.approx(1.0, abs=0.02)
    assert "further along" in fault.message
    scattered = [replace(item, value=value) for item, value in zip(conditions, (0.04, -0.03, 0.1), strict=True)]
    assert moved_roads(scattered, {"road": 10.0}, arrivals) == ()
    assert moved_roads(conditions[1:], {"road": 10.0}, arrivals) == (), "one other run tells nothing of what is usual"


def test_a_road_elsewhere_is_told_beside_starts_that_speeds_explain():
    """Slower than stated, a run meets its road later: nothing is wrong with its start."""
    faster, arrivals = {"low": -0.02, "high": 0.015, "road": 0.004}, {"low": 2.5, "high": 3.0, "road": 4.0}
    conditions = [Condition(run, "speed", "", value, "", 0.01) for run, value in faster.items()]
    late = {run: arrivals[run] * (1 / (1 + value) - 1) for run, value in faster.items()}
    starts = [Condition(run, "delay", "", value, "s", 0.2) for run, value in late.items()]
    assert moved_roads([*conditions, *starts], {"road": 10.0}, arrivals) == ()
    moved = [*starts[:2], replace(starts[2], value=late["road"] - 0.09)]
    (fault,) = moved_roads([*conditions, *moved], {"road": 10.0}, arrivals)
    assert fault.value == pytest.approx(-0.9, abs=0.01)
    assert moved_roads(moved, {"road": 10.0}, arrivals) == (), "their starts scatter, if speeds say nothing of them"


def test_a_road_elsewhere_is_told_beside_starts_that_a_clock_told():
    """Of a sedan: by the clock the others agree within 0.3 ms, by the way they are as far apart as their drivers' speeds were off."""
    delays = {"road": 0.0607, "low_fast": 0.01174, "high_slow": 0.01195, "low_slow": 0.01135}
    faster = {"road": -0.0044, "low_fast": -0.0135, "high_slow": 0.003, "low_slow": -0.014}
    arrivals = {"road": 2.6, "low_fast": 2.1, "high_slow": 2.4, "low_slow": 2.4}
    conditions = [Condition(run, "delay", "", value, "s", 0.2) for run, value in delays.items()]
    conditions += [Condition(run, "speed", "", value, "", 0.01) for run, value in faster.items()]
    (fault,) = moved_roads(conditions, {"road": 18.0}, arrivals)
    assert fault.value == pytest.approx(0.88, abs=0.01)


def test_a_start_that_speeds_alone_put_elsewhere_is_no_finding():
    """Of a healthy truck: by the clock its road's start lies among the others, which by the way happen to agree."""
    delays = {"road": -0.0116, "low_fast": 0.05, "high_fast": -0.0151, "low_slow": 0.0222}
    faster = {"road": -0.0163, "low_fast": -0.0118, "high_fast": 0.0141, "low_slow": -0.0047}
    arrivals = {"road": 2.5, "low_fast": 2.9, "high_fast": 2.7, "low_slow": 2.0}
    conditions = [Condition(run, "delay", "", value, "s", 0.2) for run, value in delays.items()]
    conditions += [Condition(run, "speed", "", value, "", 0.01) for run, value in faster.items()]
    assert moved_roads(conditions, {"road": 7.4}, arrivals) == ()
    off = [replace(item, value=item.value - 0.1) if (item.run, item.name) == ("road", "delay") else item for item in conditions]
    (fault,) = moved_roads(off, {"road": 7.4}, arrivals)
    assert fault.value < -1.0


@pytest.mark.thorough
def test_a_near_copy_of_a_pass_is_no_run_of_its_own(plain):
    low = next(trial for trial in plain if trial.name == "low")
    random = np.random.default_rng(5)
    again = low.recording.values + 0.002 * low.recording.values.std(axis=0) * random.standard_normal(low.recording.values.shape)
    copy = replace(low, name="again", recording=replace(low.recording, values=np.roll(again, 3, axis=0)))
    (fault,) = recorded_mistakes(detect([*plain, copy]))
    assert (fault.kind, set(fault.runs)) == ("copy", {"low", "again"})


@pytest.mark.thorough
def test_two_passes_over_one_hump_at_one_speed_are_no_copies(trials_of):
    twice = tuple(replace(run, name=name) for run, name in ((RUNS[0], "low"), (RUNS[0], "again"), (RUNS[2], "fast")))
    assert recorded_mistakes(detect(trials_of(runs=twice))) == ()


@pytest.mark.thorough
def test_a_drift_is_told_though_the_noise_hides_it(plain):
    def drift(values):
        values[:, F_Q] += np.linspace(0, 1, len(values))
        return values

    (fault,) = recorded_mistakes(detect(edited(plain, drift, "low")))
    assert told([fault]) == [("drift", {"low"}, ("F_q",))]


def test_healthy_runs_have_no_fault(plain):
    detection = detect(plain)
    assert recorded_mistakes(detection) == supposed_mistakes(detection) == plain_mistakes(detection) == ()


HONEST = (
    pytest.param(Effect("tyre_footprint", "all", {"length": 0.23}), id="tyre_footprint", marks=pytest.mark.slow),
    pytest.param(Effect("sensor_gain", "F_az", {"error": 0.15}), id="sensor_gain", marks=pytest.mark.slow),
    pytest.param(Effect("speed_error", "all", {"error": 0.05}), id="speed_error"),
)


@pytest.mark.parametrize("effect", HONEST)
def test_an_effect_is_no_fault(detection_of, effect):
    detection = detection_of(effect, runs=RUNS)
    assert recorded_mistakes(detection) == plain_mistakes(detection) == ()
    if max(detection.chi, detection.base.training**0.5) > NOISE_FLOOR:
        assert explain_gap(detection) == ()


@pytest.mark.thorough
def test_the_verdict_names_run_channel_and_cure(plain):
    verdict = diagnose_trials(edited(plain, times(1 / 9.81, F_AZ), "high")).verdict
    assert verdict.verdict == "measurement_fault"
    assert verdict.effects == ()
    data = verdict.to_dict()
    (fault,) = data["faults"]
    assert (fault["kind"], fault["runs"], fault["channels"]) == ("unit", ["high"], ["F_az"])
    assert "F_az is 9.807 times too small in high" in data["reason"]
    assert "unit: g" in fault["cure"]
    assert type(verdict).from_dict(data) == verdict


def test_heights_that_are_alike_are_not_exchanged():
    conditions = [Condition("low", "height", "", -0.12, "", 0.03), Condition("fast", "height", "", 0.12, "", 0.03)]
    faults = findings_of_conditions(conditions, ["low", "fast"], {"low": 0.05, "fast": 0.05})
    assert [item.kind for item in faults] == ["hump_height", "hump_height"]


def test_a_speed_that_wanders_at_several_times_is_told_once_a_run():
    conditions = [Condition("low", "wander", f"{time} s", value, "", 0.01) for time, value in ((1, 0.04), (2, -0.04), (3, 0.04))]
    faults = findings_of_conditions([*conditions, Condition("fast", "wander", "1 s", 0.04, "", 0.01)], ["low", "fast", "high"])
    assert [item.kind for item in faults] == ["wander"] * len(faults)
    assert len({item.message for item in faults}) == len(faults)
    assert {run for item in faults for run in item.runs} == {"low", "fast"}


@pytest.mark.parametrize(
    ("clocks", "told"),
    [((0.0136, 0.0139, 0.0132), True), ((-0.015, -0.016, -0.0155), True), ((0.0136, 0.0139), False), ((0.0136, 0.0139, 0.007), False)],
)
def test_what_every_run_supposes_as_much_is_told(clocks, told):
    conditions = [Condition(f"run{i}", "clock", "F", value, "s", 0.01) for i, value in enumerate(clocks)]
    conditions += [Condition(f"run{i}", "speed", "", (-1) ** i * 0.02, "", 0.01) for i in range(3)]
    runs = [f"run{i}" for i in range(len(clocks))]
    found = alike_in_all_runs(conditions, runs)
    assert len(found) == told
    assert alike_in_all_runs(conditions, [*runs, "another"]) == ()
    if told:
        assert "the clock of F in all runs is" in found[0]
        assert ("later" if clocks[0] > 0 else "earlier") in found[0]


def test_conditions_of_any_fit_are_read_by_name_place_and_size():
    conditions = [
        Condition("low", "gain", "F_az", 0.2, "", 0.03),
        Condition("high", "gain", "F_az", 0.21, "", 0.03),
        Condition("fast", "delay", "", 0.1, "s", 0.05),
        Condition("fast", "speed", "", -0.05, "", 0.005),
    ]
    faults = findings_of_conditions(conditions, ["low", "high", "fast"])
    assert [(item.kind, item.runs, item.channels) for item in faults] == [
        ("gain", ("low", "high"), ("F_az",)),
        ("speed", ("fast",), ()),
    ]
    assert "5 % less than stated" in faults[1].message
    assert "10 standard deviations" in faults[1].message
