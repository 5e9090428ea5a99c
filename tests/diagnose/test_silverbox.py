"""Measured forces on a rig without wheels: what its run files may say, and the Silverbox's recordings where they are at hand."""

import importlib
import re
from pathlib import Path

import numpy as np
import pytest

from vehgen.diagnose.detect.noise_floor import find_noise_floor
from vehgen.diagnose.pipeline import detect, diagnose_trials
from vehgen.effects import EFFECTS
from vehgen.errors import InputError
from vehgen.fit.road_answer import road_answer
from vehgen.fit.trial import load_trials
from vehgen.simulate import load_run
from vehgen.vehicle import load_vehicle

FOLDER = Path(__file__).parents[2] / "docs" / "examples" / "silverbox"
DATA = "shared/data/silverbox/SNLS80mV.csv"
RUN = """vehicle: rig.yaml
band: [2 Hz, 150 Hz]
step: 0.25 ms
forces:
  push: {body: block, file: force.csv, time: t, force: F, unit: N, noise: 0.1 N}
sensors:
  gauge: {body: block, channels: {displacement: {column: y, unit: mm, noise: 0.002 mm}}}
recording: recording.csv
"""


@pytest.fixture
def rig(tmp_path):
    """A linear rig at 500 Hz: 1000 samples of a random force and of noise."""
    random = np.random.default_rng(4)
    t = 0.002 * np.arange(1000)
    (tmp_path / "rig.yaml").write_text((FOLDER / "silverbox.yaml").read_text(encoding="utf-8"), encoding="utf-8")
    for name, column in (("force", "F"), ("recording", "y")):
        np.savetxt(
            tmp_path / f"{name}.csv", np.column_stack([t, random.standard_normal(1000)]), delimiter=",", header=f"t,{column}", comments=""
        )

    def write(*change):
        text = RUN.replace(*change) if change else RUN
        path = tmp_path / "run.yaml"
        path.write_text(text, encoding="utf-8")
        return path

    return write


def test_stated_noise_is_believed(rig):
    trials = load_trials([rig()])
    floor = find_noise_floor(trials, (2.0, 150.0))
    assert floor.noises["run"].sigma == pytest.approx([2e-6], rel=1e-12)


def test_a_force_of_known_error_comes_through_the_rig(rig):
    trial = load_trials([rig()])[0]
    frequency = np.array([5.0, 69.0, 140.0])
    known = load_vehicle(FOLDER / "silverbox.yaml").values()
    omega = 2 * np.pi * frequency
    flexibility = 1 / (known["k1"] - omega**2 * known["m1"] + 1j * omega * known["c1"])
    density = find_noise_floor([trial], (2.0, 150.0)).noises["run"].density(road_answer(trial, frequency, trial.values))[:, 0, 0]
    assert density == pytest.approx(2 * 0.002 * (0.1**2 * np.abs(flexibility) ** 2 + 2e-6**2), rel=1e-9)


def test_laws_of_suspensions_fit_the_link_of_a_rig(rig):
    vehicle = load_run(rig()).vehicle
    assert EFFECTS["cubic_stiffness"].places(vehicle, ()) == ("spring",)
    assert EFFECTS["speed_error"].places(vehicle, ()) == ()


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("[2 Hz, 150 Hz]", "[150 Hz, 2 Hz]", "the first must be the lower one"),
        ("[2 Hz, 150 Hz]", "[2 m, 150 Hz]", "expected 1/s, found m"),
        ("0.002 mm}", "0.002 kg}", "expected m, found kg"),
        ("0.002 mm}", "0 mm}", "a noise above 0 was expected"),
        ("0.1 N}", "-0.1 N}", "above 0"),
    ],
)
def test_what_cannot_be_meant_is_refused(rig, old, new, message):
    with pytest.raises(InputError, match=re.escape(message)) as caught:
        load_trials([rig(old, new)])
    assert caught.value.position is not None


def test_a_band_beyond_the_sampling_rate_is_refused(rig):
    with pytest.raises(InputError, match=r"ends at 300 Hz, but run was sampled for 250 Hz at most"):
        detect(load_trials([rig("150 Hz", "300 Hz")]))


def test_wheels_need_a_speed(rig):
    with pytest.raises(InputError, match="lacks the key 'speed': sedan2 has wheels"):
        load_run(rig("rig.yaml", "sedan2.yaml").with_name("run.yaml"))


@pytest.fixture(scope="module")
def silverbox():
    """The example's modules and the path of the benchmark's data, which are no part of the project."""
    path = next((parent / DATA for parent in Path(__file__).parents if (parent / DATA).is_file()), None)
    if path is None:
        pytest.skip("no Silverbox data here")
    with pytest.MonkeyPatch.context() as patch:
        patch.syspath_prepend(str(FOLDER))
        yield importlib.import_module("prepare"), importlib.import_module("free_run"), path


@pytest.fixture(scope="module")
def runs(silverbox, tmp_path_factory):
    prepare, _, path = silverbox
    short = {name: (first, first + 3000) for name, (first, _) in list(prepare.RUNS.items())[:3]}
    return prepare.write_runs(path, tmp_path_factory.mktemp("silverbox"), short | prepare.QUIET_RUNS)


@pytest.mark.slow
def test_the_silverbox_lacks_a_cubic_spring(runs):
    tried = [EFFECTS[name] for name in ("cubic_stiffness", "progressive_stiffness", "quadratic_damping")]
    found = diagnose_trials(load_trials(runs[:3]), tried).verdict
    assert found.verdict == "named", found.reason
    effect = found.effects[0]
    assert (effect.name, effect.place) == ("cubic_stiffness", "spring")
    assert effect.parameters["k3"].value == pytest.approx(3.92e9, rel=0.02)
    assert effect.validation_gain > 0.97


@pytest.mark.thorough
def test_at_a_low_level_nothing_is_named(runs):
    found = diagnose_trials(load_trials(runs[3:])).verdict
    assert found.verdict in ("no_missing_effect", "too_weak")
    assert found.effects == ()


@pytest.mark.thorough
def test_free_runs_of_the_test_splits_are_as_good_as_the_best(silverbox, runs):
    prepare, free_run, path = silverbox
    force, displacement = prepare.read_silverbox(path)
    fine = prepare.upsample(force)
    linear = load_vehicle(FOLDER / "silverbox.yaml")
    expected = {"multisine": (6.97, 0.355), "arrow_without_extrapolation": (6.59, 0.347), "arrow_full": (14.19, 0.451)}  # by other code
    straight = free_run.errors(linear, free_run.fit(linear, runs[:3]), fine, displacement)
    cubic = free_run.with_cubic_spring(linear)
    curved = free_run.errors(cubic, free_run.fit(cubic, runs[:3]), fine, displacement)
    for name, (without, with_spring) in expected.items():
        assert straight[name] == pytest.approx(without, rel=0.05)
        assert curved[name] < 1.03 * with_spring
