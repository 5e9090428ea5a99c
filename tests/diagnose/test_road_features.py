"""A bump or a dip of the road that no run file has."""

import re
import shutil
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from benchmarks.hidden_effects.generator import Hump as Drawn
from benchmarks.hidden_effects.generator import RunSpec

from tests.diagnose.conftest import CUBIC, HUMPS
from vehgen.diagnose.detect.detection import detect
from vehgen.diagnose.inputs.adjustments import RoadBump
from vehgen.diagnose.inputs.judging import SUBTLE
from vehgen.diagnose.inputs.refits import BaseRefits
from vehgen.diagnose.inputs.road_features import _Bump, _Run, _where, feature_hypotheses, shifted_sums
from vehgen.fit.trial import load_trials
from vehgen.road import ConstantSpeed, Hump, Track
from vehgen.simulate import Scenario

AT, LENGTH, DEPTH = 8.0, 0.8, 0.012
DIP = Drawn(LENGTH, -DEPTH, AT)


@pytest.fixture(scope="module")
def over_a_dip(record, tmp_path_factory):
    """Runs over a hump and a dip behind it, of which the run files have the hump alone."""
    runs = tuple(RunSpec((*run.road, DIP), run.speed, 6.0, run.name) for run in HUMPS)
    folder = tmp_path_factory.mktemp("dip")
    shutil.copytree(record(runs=runs)[0].parent, folder, dirs_exist_ok=True)
    paths = sorted(folder.glob("*.yaml"))
    for path in paths:
        text, n = re.subn(r".*at: 8(\.0)? m.*\n", "", path.read_text(encoding="utf-8"))
        assert n == 1
        path.write_text(text, encoding="utf-8")
    return paths


@pytest.mark.thorough
def test_a_dip_that_no_run_file_has_is_found_with_its_place_and_depth(over_a_dip):
    """The generator's dip is half a sine, what is fitted a versine: a longer and deeper one is as large."""
    case = BaseRefits(detect(load_trials(over_a_dip)))
    (found,) = feature_hypotheses(case)
    fit, left = case.judge(found)
    (fault,) = found.describe(fit.misfit.adjusted(fit.x))
    bump = found.shared[-1]
    assert left < found.limit
    assert (fault.kind, fault.runs) == ("road_feature", case.runs)
    assert [at + bump.length / 2 for _, at in bump.roads] == pytest.approx([AT + LENGTH / 2] * 3, abs=0.1)
    assert fault.value * bump.length / 2 == pytest.approx(-DEPTH * LENGTH * 2 / np.pi, rel=0.15)
    assert "a dip that the run files do not know" in fault.message
    assert feature_hypotheses in SUBTLE


@pytest.mark.thorough
def test_what_hides_in_the_vehicle_is_no_dip_of_the_road(detection_of):
    case = BaseRefits(detection_of(CUBIC, runs=HUMPS))
    left = [case.judge(item)[1] for item in feature_hypotheses(case)]
    assert len(left) <= 1
    assert min(left, default=1.0) > 0.5


def driven(detection, place, speed=0.0):
    """Return a run of a fit whose speed is off by so many standard deviations, and its answer to a bump of 1 mm, 0.5 m long, at a place."""
    fit = detection.base.least_squares
    x = np.concatenate([fit.x[: fit.misfit.n_parameters], np.zeros(fit.misfit.n_errors)])
    x[fit.misfit.n_parameters + fit.misfit.error_position(0, "speed")] = speed
    run = _Run(fit.misfit, 0, x, fit.misfit.whitened_spectrum(x)[0])
    return run, run.added_lines(_Bump(place, 0.5, 1e-3))


def test_a_bump_ahead_of_the_hump_adds_its_own_answer_alone(detection_of):
    """Where a run's speed is off, the hump of a run that first met the bump had moved."""
    detection = detection_of(runs=HUMPS)
    (_, ahead), (run, steady) = (driven(detection, 2.0, speed) for speed in (2.0, 0.0))
    assert run.scenario.humps[0].at > 2.5
    assert np.abs(ahead).sum() == pytest.approx(np.abs(steady).sum(), rel=0.1)


def test_a_bump_is_found_where_it_is_by_the_answer_to_one_elsewhere(detection_of):
    run, lines = driven(detection_of(runs=HUMPS), 7.5)
    places, numerators, denominator = replace(run, left=lines).answers(0.5)
    assert places[numerators.argmax()] == pytest.approx(7.5, abs=0.05)
    assert numerators.max() / denominator == pytest.approx(1e-3, rel=0.15)
    on_the_hump = (places < run.scenario.humps[0].end) & (places + 0.5 > run.scenario.humps[0].at)
    assert (numerators[on_the_hump] == 0).all()


def test_shifted_sums_are_those_term_by_term():
    random = np.random.default_rng(1)
    frequency, later = 0.125 * np.arange(4, 200), random.uniform(-9, 9, 50)
    lines = random.standard_normal(196) + 1j * random.standard_normal(196)
    exact = 2 * np.real(np.exp(2j * np.pi * np.outer(later, frequency)) @ lines)
    np.testing.assert_allclose(shifted_sums(lines, frequency, later), exact, atol=0.03 * np.abs(lines).sum() / 10)


def test_a_bump_is_on_the_roads_that_have_it_alone():
    drawn, other = (Hump.from_shape("half_sine", 4.0, 0.5, 0.03),), (Hump.from_shape("half_sine", 4.0, 0.5, 0.03),)
    bump = RoadBump("road", 0.01, length=0.8, roads=((drawn, 6.0),))
    mine, its = (Scenario(Track(parts), ConstantSpeed(2.0), 6.0, 1e-3, 10) for parts in (drawn, other))
    s = np.array([4.25, 6.2, 6.4])
    np.testing.assert_allclose(bump.scenario(mine, -0.01).track.height(s), [0.03, -0.005, -0.01], atol=1e-5)
    assert bump.scenario(its, -0.01) is its
    assert bump.scenario(mine, 0.0) is mine
    second = RoadBump("road", 0.01, length=0.5, roads=((drawn, 8.0),))
    both = second.scenario(bump.scenario(mine, -0.01), 0.02)
    np.testing.assert_allclose(both.track.height(np.array([4.25, 6.4, 8.25])), [0.03, -0.01, 0.02], atol=1e-5)


@pytest.mark.parametrize(
    ("humps", "places", "told"),
    [
        ((4.0, 5.0), (9.1, 9.3), "beginning 9.2 m along the road"),
        ((4.0, 5.0), (9.0, 10.1), "beginning 5.0 m behind the begin of the hump"),
        ((4.0, 5.0), (9.0, 12.0), "beginning at 9.0, 12.0 m along the road"),
    ],
    ids=["along the road", "behind the hump", "elsewhere in each"],
)
def test_where_a_bump_is_told_by_what_runs_have_in_common(humps, places, told):
    trials = [SimpleNamespace(scenario=SimpleNamespace(humps=(SimpleNamespace(at=at),))) for at in humps]
    assert _where(trials, {i: _Bump(at, 0.5, 0.01) for i, at in enumerate(places)}) == told
