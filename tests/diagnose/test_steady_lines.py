"""What shakes a vehicle all the time, before the hump too, is no noise: an engine's line, and a wheel's that is out of round."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from tests.diagnose.conftest import HUMPS
from vehgen.diagnose.detect.detection import detect
from vehgen.diagnose.detect.noise_floor import lead_in_lines
from vehgen.diagnose.detect.steady_lines import _standing_out, steady_lines
from vehgen.fit.lead_in import lead_in

ENGINE_HZ, TURNS_PER_M = 17.0, 2.5
LOUD = 8.0
"""The line's amplitude over the noise of a channel."""


@pytest.fixture(scope="module")
def shaken(trials_of, detection_of):
    """Return a function that adds a line to the first channel of the runs named, at a frequency that depends on their speed."""
    sigma = {name: noise.sigma[0] for name, noise in detection_of(runs=HUMPS).floor.noises.items()}

    def add(frequency, names=("low", "high", "fast")):
        found = []
        for trial in trials_of(runs=HUMPS):
            values = trial.recording.values.copy()
            if trial.name in names:
                phase = 2 * np.pi * frequency(trial.scenario.top_speed) * trial.recording.time
                values[:, 0] += LOUD * sigma[trial.name] * np.sin(phase + len(found))
            found.append(replace(trial, recording=replace(trial.recording, values=values)))
        return found

    return add


@pytest.mark.thorough
def test_the_line_of_an_engine_is_found_and_takes_no_part_in_the_noise(shaken, detection_of):
    clean, found = detection_of(runs=HUMPS), detect(shaken(lambda speed: ENGINE_HZ))
    assert not found.is_quiet
    for trial in found.trials:
        assert trial.lines
        assert np.abs(np.array(trial.lines) - ENGINE_HZ).max() < 0.5
        ratio = found.floor.noises[trial.name].sigma / clean.floor.noises[trial.name].sigma
        assert ratio == pytest.approx(np.ones(len(ratio)), rel=0.2)


@pytest.mark.parametrize(("width", "told"), [(1, 1), (10, 10), (40, 0)])
def test_all_of_a_line_that_wanders_stands_out_and_no_broad_resonance(width, told):
    """An engine's line of 25 Hz that wanders by 2 % lies on ten lines of a record of 20 s."""
    frequency = np.arange(1, 500) * 0.08
    power = np.random.default_rng(3).chisquare(2, (len(frequency), 2)) / 2
    power[300 : 300 + width, 0] += 300.0
    assert np.count_nonzero(_standing_out(frequency, power)) == told


def left_by(runs):
    """Return a base that leaves noise but for a line: by run its frequency [Hz], the speed [m/s], and whether it crosses humps alone."""
    frequency, parts, spectra = np.arange(1, 500) * 0.08, [], {}
    for name, (line, speed, humps) in runs.items():
        spectra[name] = np.ones((len(frequency), 1))
        spectra[name][np.abs(frequency - line) < 0.01] += 300.0
        trial = SimpleNamespace(name=name, scenario=SimpleNamespace(over_humps_alone=humps, top_speed=speed))
        misfit = SimpleNamespace(problem=SimpleNamespace(trials=[trial]), frequency=lambda number: frequency)
        parts.append(SimpleNamespace(misfit=misfit))
    return SimpleNamespace(parts=parts, spectra=spectra)


def test_the_line_of_an_engine_is_in_runs_over_rough_roads_too_and_that_of_a_wheel_at_another_speed_is_not():
    engine = left_by({"low": (24.0, 2.0, True), "high": (24.0, 4.0, True), "rough": (8.0, 10.0, False)})
    assert steady_lines(engine) == dict.fromkeys(("low", "high", "rough"), pytest.approx((24.0,)))
    wheel = left_by({"low": (8.0, 2.0, True), "high": (16.0, 4.0, True), "rough": (24.0, 10.0, False)})
    assert steady_lines(wheel) == {"low": pytest.approx((8.0,)), "high": pytest.approx((16.0,))}


@pytest.mark.slow
def test_the_line_of_a_wheel_follows_the_speed(shaken):
    found = detect(shaken(lambda speed: TURNS_PER_M * speed))
    assert not found.is_quiet
    for trial in found.trials:
        assert trial.lines == pytest.approx([TURNS_PER_M * trial.scenario.top_speed] * len(trial.lines), rel=0.05)
        assert trial.lines


@pytest.mark.thorough
def test_a_line_of_one_run_and_none_at_all_change_nothing(shaken, detection_of):
    assert not steady_lines(detection_of(runs=HUMPS).base)
    assert not any(trial.lines for trial in detect(shaken(lambda speed: ENGINE_HZ, names=("high",))).trials)


def test_a_lead_in_is_seen_without_its_lines(trials_of):
    part = next(item for trial in trials_of(runs=HUMPS) if (item := lead_in(trial)) is not None)
    kept = lead_in_lines(replace(part, lines=(ENGINE_HZ,)), (0.5, 40.0))[1].frequency
    every = lead_in_lines(part, (0.5, 40.0))[1].frequency
    lost = np.setdiff1d(every, kept)
    assert lost.min() < ENGINE_HZ < lost.max()
    assert 5 <= len(lost) <= 7
