"""Diagnoses that need more than one look: pairs of effects, lines of engines, and work that is stopped or renamed."""

import shutil
from types import SimpleNamespace

import pytest
from benchmarks.hidden_effects.generator import Effect

from tests.diagnose.conftest import CUBIC, HUMPS
from vehgen.diagnose.decision import Decision
from vehgen.diagnose.detect.detection import band_gaps, run_gaps
from vehgen.diagnose.pipeline import diagnose_trials
from vehgen.diagnose.select import early_end
from vehgen.diagnose.select.estimates import estimates_by_run
from vehgen.diagnose.writing import effect_file
from vehgen.effects import EFFECTS, EffectLocator
from vehgen.fit.trial import load_trials
from vehgen.vehicle import load_vehicle

FEW = [EFFECTS[name] for name in ("cubic_stiffness", "sensor_gain")]


PAIR = (CUBIC, Effect("sensor_gain", "F_az", {"error": 0.2}))


@pytest.fixture(scope="module")
def two(trials_of):
    return diagnose_trials(trials_of(*PAIR, runs=HUMPS), FEW)


@pytest.mark.slow
def test_two_effects_are_found_one_after_the_other(two):
    assert two.verdict.verdict == "named"
    assert {(item.name, item.place) for item in two.verdict.effects} == {("cubic_stiffness", "rear"), ("sensor_gain", "F_az")}
    values = {name: item.value for effect in two.verdict.effects for name, item in effect.parameters.items()}
    assert values["k3"] == pytest.approx(1e8, rel=0.05)
    assert values["gain"] == pytest.approx(1.2, rel=0.02)
    assert two.verdict.gap.after < 1.15
    assert len(two.rounds) >= 2


@pytest.mark.thorough
def test_the_vehicle_file_of_a_pair_holds_the_force_and_tells_of_the_sensor(two, tmp_path):
    text = effect_file(two.chosen[-1], two.detection.problem, two.verdict, tmp_path, "both")
    path = tmp_path / "both.yaml"
    path.write_text(text, encoding="utf-8")
    assert load_vehicle(path).values()["cubic_stiffness_rear_k3"] == pytest.approx(1e8, rel=0.05)
    assert "sensor_gain at F_az is an effect of the runs" in text


@pytest.mark.thorough
def test_gaps_are_told_by_run_channel_and_band(two):
    before = {(item.run, item.channel, item.band): item.chi for item in band_gaps(two.detection)}
    after = {(item.run, item.channel, item.band): item.chi for item in band_gaps(two.detection, two.chosen[-1])}
    assert before.keys() == after.keys()
    assert len({channel for _, channel, _ in before}) == 4
    assert max(after.values()) < 2 < max(before.values())


@pytest.mark.thorough
def test_every_run_alone_asks_for_the_same_spring(two):
    spring = next(item for item in two.chosen[-1].effects if item.effect.name == "cubic_stiffness")
    for own in estimates_by_run(two.chosen[-1], spring):
        assert own.value == pytest.approx(1e8, abs=max(2.5 * own.half_width, 1e7))


@pytest.mark.thorough
def test_the_gap_is_told_beside_height_and_speed(two):
    gaps = {item.run: item for item in run_gaps(two.detection)}
    assert {name: (item.height, round(item.speed, 6)) for name, item in gaps.items()} == {
        "low": (0.03, 2.0),
        "high": (0.05, 2.5),
        "fast": (0.05, 4.0),
    }
    assert all(0 < item.share < 1 < item.chi for item in gaps.values())


@pytest.mark.slow
def test_an_engine_is_found_by_its_line(trials_of):
    engine = Effect("engine_harmonic", "body", {"amplitude": 450.0, "frequency": 24.0, "drift": 0.01, "x": 0.4})
    found = diagnose_trials(trials_of(engine, runs=HUMPS), [EFFECTS[name] for name in ("engine_harmonic", "tyre_damping", "cargo_module")])
    assert found.verdict.verdict == "named"
    effect = found.verdict.effects[0]
    assert (effect.name, effect.place) == ("engine_harmonic", "body")
    assert effect.parameters["frequency"].value == pytest.approx(24.0, abs=0.02)
    assert effect.parameters["drift"].value == pytest.approx(0.01, abs=0.001)
    assert effect.parameters["amplitude"].value == pytest.approx(450.0, rel=0.1)


@pytest.mark.thorough
def test_an_untrue_wheel_is_found_by_its_turns(trials_of, tmp_path):
    wheel = Effect("wheel_runout", "rear", {"amplitude": 0.004, "radius": 0.31})
    found = diagnose_trials(trials_of(wheel, runs=HUMPS), [EFFECTS[name] for name in ("wheel_runout", "engine_harmonic", "relaxation")])
    assert found.verdict.verdict == "named"
    effect = found.verdict.effects[0]
    assert (effect.name, effect.place) == ("wheel_runout", "rear")
    for name, truth in wheel.values.items():
        low, high = effect.parameters[name].interval
        assert low <= truth <= high
        assert high - low < 0.5 * truth
    text = effect_file(found.chosen[-1], found.detection.problem, found.verdict, tmp_path, "untrue")
    assert "wheel_runout at rear shakes the vehicle, which no vehicle file says" in text


@pytest.mark.thorough
def test_a_loose_damper_is_told_with_its_play(trials_of):
    """Its knocks are read as they come about, not a sample sooner or later: else no fit would find the way to the play."""
    loose = Effect("damper_free_play", "front", {"play": 0.005})
    library = [EFFECTS[name] for name in ("damper_free_play", "dry_friction", "relaxation", "quadratic_damping")]
    (effect,) = diagnose_trials(trials_of(loose, runs=HUMPS), library).verdict.effects
    assert (effect.name, effect.place) == ("damper_free_play", "front")
    low, high = effect.parameters["play"].interval
    assert low <= 0.005 <= high < low + 0.0005


@pytest.mark.slow
def test_ctrl_c_leaves_what_was_found(trials_of, monkeypatch):
    monkeypatch.setattr(early_end, "MOST_AT_ONCE", 0)

    def tell(stage, done, total, best):
        if stage == "name" and done == 2:
            raise KeyboardInterrupt

    found = diagnose_trials(trials_of(*PAIR, runs=HUMPS), FEW, progress=tell)
    assert found.stopped
    assert found.verdict.verdict == "insufficient_data"
    assert "stopped by hand after 2 candidates" in found.verdict.reason
    assert len(found.fits) == 2
    assert found.places


@pytest.mark.slow
def test_the_order_of_runs_and_the_names_of_channels_change_nothing_but_names(record, two, tmp_path):
    folder = tmp_path / "renamed"
    shutil.copytree(record(*PAIR, runs=HUMPS)[0].parent, folder)
    for path in folder.glob("*.csv"):
        path.write_text(path.read_text(encoding="utf-8").replace("F_az", "zz").replace("R_q", "aa"), encoding="utf-8")
    for path in folder.glob("*.yaml"):
        path.write_text(path.read_text(encoding="utf-8").replace("F_az", "zz").replace("R_q", "aa"), encoding="utf-8")
    found = diagnose_trials(load_trials(sorted(folder.glob("*.yaml"))[::-1]), FEW)
    assert (found.verdict.verdict, found.verdict.gap) == (two.verdict.verdict, two.verdict.gap)
    renamed = [(item.name, item.place.replace("zz", "F_az"), item.parameters) for item in found.verdict.effects]
    assert renamed == [(item.name, item.place, item.parameters) for item in two.verdict.effects]


@pytest.mark.slow
def test_one_sensor_late_is_the_other_one_early(trials_of):
    found = diagnose_trials(trials_of(Effect("sensor_delay", "F", {"time": 0.06})), [EFFECTS["sensor_delay"]])
    delays = {item.place: item.parameters["delay"].value for item in found.verdict.effects}
    assert found.verdict.verdict == "ambiguous"
    assert delays == {"F": pytest.approx(0.06, abs=0.025), "R": pytest.approx(-0.06, abs=0.025)}  # any clock may be 10 ms off
    assert "clock" in (found.verdict.next_experiment or "")


@pytest.mark.thorough
@pytest.mark.parametrize(("name", "place"), [("cargo_module", "body"), (None, None)])
def test_nothing_lives_on_what_an_effect_has_added(detection_of, name, place):
    """The mount of a load that is supposed is no place for a further effect."""
    detection = detection_of(CUBIC, runs=HUMPS)
    vehicle = detection.trials[0].run.vehicle
    changed = vehicle if name is None else vehicle.with_changes(EFFECTS[name].change(EffectLocator(vehicle, vehicle.values()).site(place)))
    trial = SimpleNamespace(run=SimpleNamespace(vehicle=changed))
    fit = SimpleNamespace(least_squares=SimpleNamespace(misfit=SimpleNamespace(problem=SimpleNamespace(trials=[trial]))))
    library = [EFFECTS["dry_friction"], EFFECTS["damper_mount"], EFFECTS["sensor_gain"]]
    found = Decision(detection, library, False, lambda *_: None)._candidates(fit)
    assert {item.place for item in found} == {"front", "rear", "all suspensions", "F_az", "F_q", "R_az", "R_q"}
    assert (set(changed.links) > set(vehicle.links)) == (name is not None)
