"""A second look at what a recorder and a profile did, once a better model fits: what was taken too large is taken back."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from benchmarks.hidden_effects.generator import Effect

from tests.diagnose.conftest import CUBIC, HUMPS
from vehgen.diagnose import decision
from vehgen.diagnose.decision import Decision
from vehgen.diagnose.detect.detection import look_again
from vehgen.diagnose.detect.road_error import measured_profiles
from vehgen.diagnose.fits.model_fit import fit_base
from vehgen.diagnose.pipeline import with_evidence
from vehgen.diagnose.select import search
from vehgen.effects import EFFECTS
from vehgen.fit.chain_estimate import ChainEstimate
from vehgen.fit.chain_losses import ChainFit
from vehgen.fit.noise import LARGEST_LEVEL
from vehgen.fit.recorders import FoundRecorder
from vehgen.measure.acquisition import AcquisitionChain


@pytest.fixture(scope="module")
def detection(detection_of):
    return detection_of()


def test_where_nothing_changes_there_is_no_second_look(detection):
    assert look_again(detection, detection.base) is None


def test_a_profile_taken_for_rough_is_measured_again(detection):
    """As if a missing effect had passed for a profile's error; the true recordings know of none."""
    rough = {trial.name for trial in detection.trials if measured_profiles(trial)}
    assert rough == {"rough"}
    noises = dict(detection.floor.noises)
    noises["rough"] = replace(noises["rough"], levels=np.minimum(1e4 * noises["rough"].levels, LARGEST_LEVEL))
    spoilt = replace(detection, floor=replace(detection.floor, noises=noises))
    found = look_again(spoilt, detection.base)
    assert found is not None
    assert found.floor.noises["rough"].levels == pytest.approx(detection.floor.noises["rough"].levels, rel=0.5)
    assert found.floor.noises["high"] is detection.floor.noises["high"]
    assert found.chi == pytest.approx(detection.chi, rel=0.03)


def spoilt_by(detection, is_clear):
    """Return the detection as if a low-pass at 8 Hz had been found that nothing was recorded through."""
    wrong = ChainFit(AcquisitionChain("butterworth", 2, 8.0), 1.0)
    recorder = FoundRecorder(ChainEstimate(wrong, (), 1.0, is_clear), (0.5, 30.0), True, detection.trials[0].channels)
    return replace(
        detection,
        recorder=recorder,
        problem=detection.problem.with_trials(recorder.applied(detection.problem.trials)),
        validation_runs=tuple(recorder.applied(detection.validation_runs)),
        band=recorder.band,
    )


@pytest.mark.thorough
@pytest.mark.parametrize("is_clear", [True, False])
def test_a_recorder_is_judged_by_the_better_model_however_clear_it_was(detection, is_clear):
    """A missing effect can look like a low-pass that nothing else comes near."""
    found = look_again(spoilt_by(detection, is_clear), detection.base)
    assert found is not None
    assert found.recorder is not None
    assert found.recorder.chain.cut_off is None or found.recorder.chain.cut_off > 30.0
    assert all(trial.scenario.chain(name) == found.recorder.chain for trial in found.trials for name in trial.channels)
    assert found.band == found.recorder.band
    assert found.chi == pytest.approx(detection.chi, rel=0.05)


@pytest.mark.slow
def test_a_second_look_may_check_the_effect_by_another_run(monkeypatch, detection_of):
    """What places leave is told of the runs that are fitted: with the old runs' errors it could not be used any more."""
    first = detection_of(CUBIC, runs=HUMPS)
    others = [trial for trial in first.trials if trial.name != "low"]
    held = [trial for trial in first.trials if trial.name == "low"]
    problem = first.problem.with_trials(others)
    base = fit_base(problem, held, first.floor.noises, first.band)
    second = [replace(first, problem=problem, validation_runs=tuple(held), base=base)]
    assert [trial.name for trial in first.validation_runs] != ["low"]
    monkeypatch.setattr(decision, "look_again", lambda detection, fit: second.pop() if second else None)
    decided = Decision(first, [EFFECTS["cubic_stiffness"]], False, lambda stage, done, total, best: None).decide()
    found = with_evidence(decided, lambda stage, done, total, best: None)
    assert not second
    assert [(item.name, item.place) for item in found.verdict.effects] == [("cubic_stiffness", "rear")]
    assert {run.run for run in found.verdict.gap.runs if run.validation} == {"low"}


@pytest.mark.slow
def test_what_one_look_leaves_as_it_was_is_not_looked_at_again(monkeypatch, detection_of):
    looks = []
    monkeypatch.setattr(decision, "look_again", lambda detection, fit: looks.append(fit.label))
    decided = Decision(detection_of(CUBIC, runs=HUMPS), [EFFECTS["cubic_stiffness"]], False, lambda stage, done, total, best: None).decide()
    assert decided.verdict.verdict == "named"
    assert looks == ["cubic_stiffness at rear"]


@pytest.mark.slow
def test_noise_is_told_by_the_law_of_the_place_where_nothing_is_named_by_the_base(monkeypatch, detection_of):
    """A truck whose fifth wheel stuck was shaken by the road as its linear model would not be: the right law left chi 1.6."""
    friction = Effect("dry_friction", "rear", {"force": 800.0})
    known = detection_of(friction, runs=HUMPS)
    noises = {name: replace(noise, sigma=noise.sigma / 3) for name, noise in known.floor.noises.items()}
    base = fit_base(known.problem, known.validation_runs, noises, known.band, known.base)
    quiet = replace(known, base=base, floor=replace(known.floor, noises=noises))
    monkeypatch.setattr(decision, "LOOK_AGAIN_SHARE", 0.0)
    second = [known]
    monkeypatch.setattr(search, "look_again", lambda detection, fit: second.pop() if second else None)

    found = Decision(quiet, [EFFECTS["dry_friction"]], False, lambda stage, done, total, best: None).decide().verdict
    assert not second
    assert [(item.name, item.place) for item in found.effects] == [("dry_friction", "rear")]
    assert found.gap.after < 1.05


@pytest.mark.thorough
def test_ctrl_c_in_the_second_search_is_told(monkeypatch, detection_of):
    detection = detection_of(CUBIC, runs=HUMPS)
    monkeypatch.setattr(decision, "noise_by_its_law", lambda detection, first: detection)
    for stopped in (True, False):
        ended = SimpleNamespace(stopped=stopped, verdict=SimpleNamespace(effects=()))
        monkeypatch.setattr(Decision, "_explain_gap", lambda self, anew, ended=ended: ended)
        first = Decision(detection, [], False, lambda stage, done, total, best: None)
        assert first._otherwise(SimpleNamespace()) is None
        assert first.interrupted == stopped


@pytest.mark.slow
def test_noise_is_not_told_by_a_law_that_does_not_stick_nor_by_one_elsewhere(detection_of):
    detection = detection_of(CUBIC, runs=HUMPS)
    decided = Decision(detection, [EFFECTS["cubic_stiffness"]], False, lambda stage, done, total, best: None).decide()
    (first,) = decided.models.rounds
    assert "suspension rear" in [item.place.label for item in first.passed]
    assert search.noise_by_its_law(detection, first) is None
    assert search.noise_by_its_law(detection, replace(first, passed=())) is None
