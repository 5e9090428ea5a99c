"""Trials as they serve for slow motions: long steps and no ideal low-pass, where that changes those motions little."""

from dataclasses import replace

import numpy as np
import pytest

from tests.fit.test_harmonic import RUN, SIGMA, record, trial_of
from vehgen.fit.misfit import Misfit
from vehgen.fit.noise import EVEN, Noise
from vehgen.fit.problem import make_problem
from vehgen.measure.acquisition import UNKNOWN, AcquisitionChain
from vehgen.road import MeasuredProfile


@pytest.fixture(scope="module")
def trial(tmp_path_factory):
    folder = tmp_path_factory.mktemp("slow")
    return trial_of(folder, record(folder, RUN))[0]


@pytest.mark.parametrize(("highest", "step"), [(4.0, 1e-2 / 3), (10.0, 1e-2 / 6)])
def test_slow_motions_over_a_hump_are_those_of_short_steps(trial, highest, step):
    slow = trial.for_slow_motions(highest)
    assert slow.scenario.dt == pytest.approx(step)
    assert slow.scenario.time[-1] == pytest.approx(trial.scenario.time[-1])
    lines = []
    for item in (trial, slow):
        problem = make_problem([item])
        misfit = Misfit(problem, {item.name: Noise(EVEN, SIGMA)}, problem.space.start, band=(0.5, highest))
        x = np.concatenate([problem.space.unit(problem.space.start), np.zeros(misfit.n_errors)])
        lines.append(misfit.channel_lines(0, misfit.motions(x)[0], misfit.errors_of(x, 0)))
    error = np.linalg.norm(lines[1] - lines[0], axis=0) / np.linalg.norm(lines[0], axis=0)
    assert np.all(error < 0.01)
    assert np.all(error > 0)  # it is another simulation


def test_fast_motions_and_rough_roads_keep_their_steps(trial):
    assert trial.for_slow_motions(20.0) is trial
    profile = MeasuredProfile(np.linspace(0.0, 50.0, 501), np.zeros(501))
    track = replace(trial.scenario.track, parts=(*trial.scenario.track.parts, profile))
    rough = replace(trial, scenario=replace(trial.scenario, track=track))
    assert rough.for_slow_motions(4.0) is rough


def test_an_ideal_low_pass_is_left_out_where_it_passes_all_and_little_folds():
    late = AcquisitionChain("ideal", cut_off=45.0, delay=0.01, resolution=0.1)
    assert late.for_slow_motions(10.0, 100.0) == AcquisitionChain("none", delay=0.01, resolution=0.1)
    assert UNKNOWN.for_slow_motions(4.0, 100.0).is_point_sample
    assert late.for_slow_motions(20.0, 100.0) is late  # from 80 Hz on motions would fold
    assert late.for_slow_motions(12.0, 100.0) is late  # from 88 Hz on, 7 times as fast
    low = AcquisitionChain("ideal", cut_off=5.0)
    assert low.for_slow_motions(10.0, 100.0) is low
    assert low.for_slow_motions(5.0, 100.0) is low  # it halves them there
    assert low.for_slow_motions(4.5, 100.0).is_point_sample
    recursive = AcquisitionChain("bessel", 4, 45.0)
    assert recursive.for_slow_motions(4.0, 100.0) is recursive
