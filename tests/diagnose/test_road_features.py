"""A bump or a dip of the road that no run file has."""

import re
import shutil
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
from vehgen.diagnose.inputs.road_features import _Bump, _where, feature_hypotheses
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
    assert all(case.judge(item)[1] > item.limit for item in feature_hypotheses(case))


def test_a_bump_is_on_the_roads_that_have_it_alone():
    drawn, other = (Hump.from_shape("half_sine", 4.0, 0.5, 0.03),), (Hump.from_shape("half_sine", 4.0, 0.5, 0.03),)
    bump = RoadBump("road", 0.01, length=0.8, roads=((drawn, 6.0),))
    mine, its = (Scenario(Track(parts), ConstantSpeed(2.0), 6.0, 1e-3, 10) for parts in (drawn, other))
    s = np.array([4.25, 6.2, 6.4])
    np.testing.assert_allclose(bump.scenario(mine, -0.01).track.height(s), [0.03, -0.005, -0.01], atol=1e-5)
    assert bump.scenario(its, -0.01) is its
    assert bump.scenario(mine, 0.0) is mine


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
