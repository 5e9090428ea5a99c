"""Rigs' cases: what is drawn, recorded and written, and that vehgen reads the files as they are meant."""

import json
from dataclasses import replace

import numpy as np
import pytest
import yaml
from benchmarks.measured_world.chain import RATE
from benchmarks.measured_world.make import make_set
from benchmarks.measured_world.rigs import carriage
from benchmarks.measured_world.rigs.cases import RANGE, Chain, Hidden, with_exact_inputs, with_true_file
from benchmarks.measured_world.rigs.files import write_rig
from benchmarks.measured_world.rigs.hidden import LAWS, Scales, accepted
from benchmarks.measured_world.rigs.recorder import BEFORE, record
from benchmarks.measured_world.rigs.sets import FAMILIES, draw_rig
from benchmarks.measured_world.rigs.strength import strength
from benchmarks.measured_world.sets import SETS

import vehgen


def bare(family, seed):
    return FAMILIES[family].draw("case", np.random.default_rng([77, seed]))


@pytest.fixture(scope="module")
def pushed():
    """A carriage with one channel, one run of a shaker, and its motions."""
    rig = next(rig for rig in (bare("carriage", seed) for seed in range(50)) if not rig.numbers["servo"] and len(rig.channels) == 1)
    run = rig.runs[0]
    return rig, run, carriage.respond(rig, run, carriage.drive(rig, run))[0]


def test_a_case_depends_on_set_seed_and_number_alone(monkeypatch):
    monkeypatch.setattr("benchmarks.measured_world.rigs.sets.draw_hidden", lambda option, places, found, rng: (option, rng.random()))
    for family in FAMILIES.values():
        monkeypatch.setattr(family, "drive", lambda rig, run: {})
        monkeypatch.setattr(family, "respond", lambda rig, run, inputs: ({}, None))
    monkeypatch.setattr("benchmarks.measured_world.rigs.sets.scales", lambda rig, motions, joint: None)
    for number in range(12):
        drawn = [repr(draw_rig(stream, seed, number)) for stream, seed in ((1, 3), (1, 3), (SETS["sealed"], 3), (1, 4))]
        assert drawn[0] == drawn[1]
        assert len(set(drawn)) == 3


@pytest.mark.slow
def test_a_set_made_twice_is_the_same_to_the_byte_and_keeps_its_truth_apart(tmp_path):
    for name in ("one", "two"):
        make_set("trial", 2, "rigs", 1, tmp_path / name)
    one, two = (sorted(path.relative_to(tmp_path / name) for path in (tmp_path / name).rglob("*.*")) for name in ("one", "two"))
    assert one == two
    assert all((tmp_path / "one" / path).read_bytes() == (tmp_path / "two" / path).read_bytes() for path in one)
    cases = [path for path in one if path.parts[0] == "cases"]
    truth = json.loads((tmp_path / "one" / "truth" / "rigs_000" / "truth.json").read_text())
    assert truth["vehicle"] == "half_car"
    hidden = [item["name"] for item in truth["effects"]]
    assert not any(word in (tmp_path / "one" / path).read_text() for path in cases for word in (*hidden, "truth", "hidden"))


def test_every_option_of_a_family_comes_once_before_any_comes_again(monkeypatch):
    drawn = []
    for place, family in enumerate(FAMILIES.values()):
        drawn.clear()
        monkeypatch.setattr(family, "drive", lambda rig, run: {})
        monkeypatch.setattr(family, "respond", lambda rig, run, inputs: ({}, None))
        monkeypatch.setattr("benchmarks.measured_world.rigs.sets.scales", lambda rig, motions, joint: None)
        monkeypatch.setattr("benchmarks.measured_world.rigs.sets.draw_hidden", lambda option, *rest: drawn.append(option) or ())
        count = len(family.OPTIONS)
        for turn in range(count):
            draw_rig(SETS["trial"], 9, place + 3 * turn)
        assert sorted(drawn + ["nothing"] * family.OPTIONS.count("nothing")) == sorted(family.OPTIONS)


@pytest.mark.parametrize("family", list(FAMILIES))
def test_true_values_lie_within_the_ranges_that_the_file_states(family):
    for seed in range(30):
        rig = bare(family, seed)
        assert len(rig.runs) >= 3
        for item in rig.quantities.values():
            ratio = item.true / item.stated
            assert RANGE[0] < ratio < RANGE[1] if item.uncertain else abs(ratio - 1.0) < 0.05


@pytest.mark.thorough
def test_a_channel_reads_late_with_its_gain_and_offset(pushed):
    rig, run, _ = pushed
    t = np.arange(round(run.duration * RATE) + 1) / RATE
    motion = np.sin(2.0 * np.pi * t) * np.minimum(t, 1.0) ** 3
    chain = Chain(1.02, 0.3, 0.004, 0.05, 0.0)
    channel = replace(rig.channels[0], chain=chain, motion="wave", quantity="velocity")
    wave = replace(rig, channels=(channel,), inputs=(), recorder=replace(rig.recorder, cutoff=0.45 * rig.recorder.rate, kind="none"))
    found = record(wave, run, {"wave": motion})
    expected = 1.02 * np.interp(found.t - 0.004, t, motion) + 0.3
    assert found.clean[channel.name] == pytest.approx(expected, abs=1e-5)
    noise = found.channels[channel.name] - found.clean[channel.name]
    assert np.std(noise) == pytest.approx(found.sigma[channel.name], rel=0.01)
    assert np.mean(noise) == pytest.approx(0.0, abs=5.0 * found.sigma[channel.name] / np.sqrt(len(noise)))
    assert found.t[-1] <= run.duration - 2.0 * BEFORE


@pytest.mark.thorough
def test_a_servo_and_its_measured_force_make_the_same_motion():
    rig = next(rig for rig in (bare("carriage", seed) for seed in range(50)) if rig.numbers["servo"])
    rig = replace(rig, hidden=(Hidden("dry_friction", "rail", {"force": 0.1 * rig.numbers["size"]}),))
    run = rig.runs[0]
    motions = carriage.respond(rig, run, carriage.drive(rig, run))[0]
    mass, damping = rig.true("M"), rig.true("c")
    missing = motions["push"] - mass * motions["acceleration"] - damping * motions["velocity"]
    slides = np.abs(motions["velocity"]) > 1e-3
    sign = np.sign(motions["velocity"][slides])
    assert missing[slides] == pytest.approx(0.1 * rig.numbers["size"] * sign, rel=1e-6)
    assert np.max(np.abs(motions["displacement"])) < 2.0


@pytest.mark.slow
def test_what_a_parameter_can_take_off_is_not_distinct(pushed):
    """A spring-like or friction-like law remains; a law that only adds damping does not."""
    rig, run, _ = pushed
    rig = replace(rig, runs=(replace(run, duration=3.0),))
    size = rig.numbers["size"]
    rubbing = strength(replace(rig, hidden=(Hidden("dry_friction", "rail", {"force": 0.1 * size}),)), carriage)
    assert 0.02 * rubbing["raw"] < rubbing["distinct"] < rubbing["raw"]
    more = Hidden("asymmetric_damping", "rail", {"ratio": 1.0})
    none = strength(replace(rig, hidden=(more,)), carriage)
    assert none["raw"] < 1e-3
    damped = replace(rig, quantities={**rig.quantities, "c": replace(rig.quantities["c"], true=1.05 * rig.true("c"))})
    weak = strength(replace(damped, hidden=(Hidden("quadratic_damping", "rail", {"c2": 1e-9}),)), carriage)
    assert weak["distinct"] < 1e-2


def test_sharp_hysteresis_and_friction_by_direction_may_be_called_dry_friction():
    scale = Scales(1e4, 1e3, 0.05, 0.05, 0.02, 0.5, 500.0)
    assert accepted("hysteresis", {"force": 40.0, "travel": 0.001, "beta": 0.5}, scale) == {"dry_friction": {"force": 40.0}}
    assert accepted("hysteresis", {"force": 40.0, "travel": 0.005, "beta": 0.5}, scale) == {}
    assert accepted("directional_friction", {"bump": 10.0, "rebound": 30.0}, scale) == {"dry_friction": {"force": 20.0}}
    assert all(accepted(law, {}, scale) == {} for law in LAWS if law not in ("hysteresis", "directional_friction"))


@pytest.mark.thorough
@pytest.mark.parametrize(
    ("family", "seed"), [("half_car", 0), ("half_car", 2), pytest.param("dyno", 1, marks=pytest.mark.slow), ("carriage", 3)]
)
def test_vehgen_moves_a_healthy_rig_as_recorded_to_within_the_noise(family, seed, tmp_path):
    """Files with the true parameters and exact inputs leave the sensors' noise: signs, units and places are as they are meant."""
    rig = with_exact_inputs(with_true_file(bare(family, seed)))
    rig = replace(rig, runs=rig.runs[:2])
    sigma = write_rig(rig, tmp_path)
    for run in rig.runs:
        path = tmp_path / f"{run.name}.yaml"
        response = vehgen.simulate(path)
        table = np.genfromtxt(path.with_suffix(".csv"), delimiter=",", names=True)
        signs = {
            item["column"]: item.get("sign", 1)
            for sensor in yaml.safe_load(path.read_text())["sensors"].values()
            for item in sensor["channels"].values()
        }
        for name in table.dtype.names[1:]:
            simulated = np.interp(table["t"], response.time, np.ravel(response.channel(name)))
            left = (signs[name] * table[name] - simulated)[:-5]
            assert np.sqrt(np.mean(left**2)) < 1.1 * sigma[run.name][name] + 1e-4 * np.std(table[name]), name
