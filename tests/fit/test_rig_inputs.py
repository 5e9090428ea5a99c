"""What a rig's recording must agree with, and what a fit finds of its displacements and its release; against exact motions."""

import numpy as np
import pytest

from vehgen.errors import InputError
from vehgen.fit.least_squares import FitOptions, fit_least_squares
from vehgen.fit.linearisation import linearise
from vehgen.fit.misfit import Misfit
from vehgen.fit.noise import EVEN, Noise
from vehgen.fit.nuisances import Nuisances
from vehgen.fit.problem import Problem
from vehgen.fit.space import SearchSpace
from vehgen.fit.trial import Trial, load_trials
from vehgen.fit.window import AFTER_RELEASE, RAMP, taper

MASS, K, C = 20.0, 40e3, 80.0
RIG = f"""name: rig
bodies: {{block: {{mass: {MASS} kg, motions: [heave]}}}}
links: {{mount: {{ground: {{}}, block: {{}}, k: {K} N/m, c: {C} N s/m}}}}
"""
RUN = """vehicle: rig.yaml
band: [0.3 Hz, 40 Hz]
acquisition: none
duration: 4 s
displacements: {mount: {file: stroke.csv, time: t, displacement: x, unit: UNIT}}
sensors: {gauge: {body: block, channels: {displacement: y, velocity: v}}}
recording: recording.csv
"""
RELEASE = """vehicle: rig.yaml
step: 0.1 ms
acquisition: none
initial: {block: {displacement: BEGIN}}
sensors: {gauge: {body: block, channels: {displacement: y}}}
recording: recording.csv
"""
NOTHING = SearchSpace((), np.zeros(0), np.zeros(0), np.zeros(0))


def table(path, header, *columns):
    np.savetxt(path, np.column_stack(columns), delimiter=",", header=header, comments="", fmt="%.9g")


def free(t, begin):
    """Return the exact displacement of the released block."""
    decay, omega = C / (2 * MASS), np.sqrt(K / MASS - (C / (2 * MASS)) ** 2)
    return begin * np.exp(-decay * t) * (np.cos(omega * t) + decay / omega * np.sin(omega * t))


def shaken(t, parts):
    """Return displacement and velocity of the block on a base that moves by the sum of a sin(2 pi f t), from rest with it: steady part."""
    y, v = np.zeros_like(t), np.zeros_like(t)
    for amplitude, f in parts:
        w = 2j * np.pi * f
        answer = amplitude * (K + w * C) / (MASS * w**2 + w * C + K) * np.exp(w * t)
        y, v = y + answer.imag, v + (w * answer).imag
    return y, v


def write(folder, text, recording):
    (folder / "rig.yaml").write_text(RIG, encoding="utf-8")
    (folder / "run.yaml").write_text(text, encoding="utf-8")
    table(folder / "recording.csv", *recording)
    return folder / "run.yaml"


def fitted(trial, sigma, **sigmas):
    options = FitOptions(Nuisances(gain=0, clock=0, **sigmas), (0.3, 40.0))
    fit = fit_least_squares(Problem((trial,), NOTHING), np.zeros(0), options, noises={trial.name: Noise(EVEN, sigma)})
    return fit, {item.name: item for item in fit.conditions()}


def test_the_gain_of_a_displacement_is_found_in_whatever_unit_it_comes(tmp_path):
    t = np.arange(0.0, 12.0, 1e-3)
    parts = [(0.004, 0.7), (0.003, 2.3), (0.001, 6.1), (0.0004, 12.7)]
    stroke = sum(a * np.sin(2 * np.pi * f * t) for a, f in parts)
    recorded = np.column_stack(shaken(t, parts))
    sigma = np.array([2e-6, 2e-4])
    recorded += sigma * np.random.default_rng(2).standard_normal(recorded.shape)
    later = t >= 4.0  # the steady part: the block was not at rest with the base
    run = write(tmp_path, RUN.replace("UNIT", "mm"), ("t,y,v", (t - 4.0)[later][::10], recorded[later][::10]))
    start = shaken(np.array([4.0]), parts)
    text = RUN.replace("UNIT", "mm") + f"initial: {{block: {{displacement: {start[0][0]} m, velocity: {start[1][0]} m/s}}}}\n"
    run.write_text(text, encoding="utf-8")
    table(tmp_path / "stroke.csv", "t,x", t - 4.0, 1e3 * stroke / 1.02)
    (trial,) = load_trials([run])
    _, found = fitted(trial, sigma)
    assert found["displacement_gain"].place == "mount"
    assert found["displacement_gain"].value == pytest.approx(0.02, abs=1e-3)
    assert "displacement_gain" not in fitted(trial, sigma, displacement_gain=0)[1]


def test_a_release_that_is_stated_with_a_tolerance_is_found(tmp_path):
    t = np.arange(0.0, 3.0, 0.01)
    sigma = np.array([1e-5])
    recorded = free(t, 0.066) + sigma * np.random.default_rng(1).standard_normal(len(t))
    run = write(tmp_path, RELEASE.replace("BEGIN", "{value: 60 mm, tolerance: 5 mm}"), ("t,y", t, recorded))
    (trial,) = load_trials([run])
    fit, found = fitted(trial, sigma)
    item = found["initial_displacement"]
    assert (item.run, item.place, item.unit, item.sigma) == (trial.name, "block", "m", 0.005)
    assert item.value == pytest.approx(0.006, abs=1e-4)
    assert fit.chi2 < 1.3
    exact = write(tmp_path, RELEASE.replace("BEGIN", "60 mm"), ("t,y", t, recorded))
    assert "initial_displacement" not in fitted(load_trials([exact])[0], sigma)[1]


@pytest.mark.parametrize(
    ("begin", "recorded", "refused"),
    [
        ("60 mm", 0.058, False),
        ("60 mm", 0.005, True),
        ("60 mm", -0.06, True),
        ("{value: 60 mm, tolerance: 20 mm}", 0.005, False),
        ("{value: 60 mm, tolerance: 1 mm}", 0.005, True),
    ],
)
def test_a_release_that_its_recording_contradicts_is_refused_where_it_is_stated(tmp_path, begin, recorded, refused):
    t = np.arange(0.0, 3.0, 0.01)
    run = write(tmp_path, RELEASE.replace("BEGIN", begin), ("t,y", t, free(t, recorded)))
    if not refused:
        assert load_trials([run])
        return
    with pytest.raises(InputError, match=r"begin with y at 0\.06 m, but its recording begins at .*put `initial` right") as caught:
        load_trials([run])
    assert (caught.value.position.line, caught.value.position.column) == (4, 1)
    assert "\n" not in str(caught.value)


def test_a_false_zero_of_a_motion_contradicts_no_release(tmp_path):
    t = np.arange(0.0, 3.0, 0.01)
    rate = np.gradient(free(t, 0.001), t)
    rate[0] = 0.0
    text = RELEASE.replace("BEGIN", "1 mm").replace("{displacement: y}", "{velocity: y}")
    biased = rate + 2 * np.abs(rate).max()
    assert load_trials([write(tmp_path, text, ("t,y", t, biased))])


def test_a_load_cell_that_says_otherwise_contradicts_a_release_too(tmp_path):
    t = np.arange(0.0, 3.0, 0.01)
    text = RELEASE.replace("BEGIN", "60 mm").replace(
        "{body: block, channels: {displacement: y}}", "{link: mount, channels: {link_force: y}}"
    )
    assert load_trials([write(tmp_path, text, ("t,y", t, -K * free(t, 0.05)))])
    with pytest.raises(InputError, match=r"begin with y at -2\.4e\+03 N, but its recording begins at -[0-9]+ N"):
        load_trials([write(tmp_path, text, ("t,y", t, -K * free(t, 0.003)))])


@pytest.mark.parametrize(("first", "last", "words"), [(0.0, 2.5, "from 0 s to 2.5 s"), (0.5, 4.0, "from 0.5 s to 4 s")])
def test_an_input_shorter_than_its_recording_is_refused(tmp_path, first, last, words):
    t = np.arange(0.0, 4.0, 0.01)
    run = write(tmp_path, RUN.replace("UNIT", "m"), ("t,y,v", t, *shaken(t, [(1e-3, 2.0)])))
    stroke = np.arange(first, last + 1e-9, 0.002)
    table(tmp_path / "stroke.csv", "t,x", stroke, 1e-3 * np.sin(stroke))
    with pytest.raises(InputError, match=f"displacement mount is known {words}, the recording lasts from 0 s to") as caught:
        load_trials([run])
    assert caught.value.position.line == 5
    (tmp_path / "stroke.csv").write_text("t,x\n0,0.001\n", encoding="utf-8")
    assert load_trials([run])  # one row is a constant


@pytest.mark.parametrize(
    ("unit", "words"),
    [
        (", unit: UNIT", "column 'x' has no unit; write the one it was recorded in, e.g. `unit: m`"),
        ("UNIT", "unknown unit 'inch'; did you mean"),
        ("UNIT", "displacement is measured in m, found 'kN'"),
    ],
)
def test_a_measured_input_states_its_unit_beside_a_recording(tmp_path, unit, words):
    t = np.arange(0.0, 4.0, 0.01)
    text = RUN.replace(unit, {"column": "", "unknown": "inch"}.get(words.split()[0], "kN"))
    table(tmp_path / "stroke.csv", "t,x", t, 1e-3 * np.sin(t))
    with pytest.raises(InputError, match=words) as caught:
        load_trials([write(tmp_path, text, ("t,y,v", t, np.sin(t), np.cos(t)))])
    assert caught.value.position.line == 5


def test_a_run_whose_begin_is_stated_is_compared_from_there_on(tmp_path):
    t = np.arange(0.0, 3.0, 0.01)
    text = RELEASE.replace("BEGIN", "60 mm")
    recording = "t,y", t, free(t, 0.06)
    (stated,) = load_trials([write(tmp_path, text, recording)])
    assert stated.fade_in == 0.0
    (filtered,) = load_trials([write(tmp_path, text.replace("acquisition: none", "acquisition: unknown"), recording)])
    assert filtered.fade_in == AFTER_RELEASE
    (unstated,) = load_trials([write(tmp_path, text.replace("initial: {block: {displacement: 60 mm}}\n", ""), recording)])
    assert unstated.fade_in == RAMP
    whole = taper(len(t), 0.01, 0.0)
    assert (whole[: len(t) // 2] == 1).all()
    assert whole[len(t) // 2 :] == pytest.approx(taper(len(t), 0.01)[len(t) // 2 :])
    assert taper(len(t), 0.01)[0] == 0.0


def test_a_release_that_dies_at_once_tells_its_damping(tmp_path, monkeypatch):
    t, sigma, c = np.arange(0.0, 3.0, 0.005), np.array([1e-5]), 700.0
    decay = c / (2 * MASS)
    omega = np.sqrt(K / MASS - decay**2)
    recorded = 0.06 * np.exp(-decay * t) * (np.cos(omega * t) + decay / omega * np.sin(omega * t))
    recorded += sigma * np.random.default_rng(4).standard_normal(len(t))
    run = write(tmp_path, RELEASE.replace("BEGIN", "60 mm"), ("t,y", t, recorded))
    searched = "parameters: {c: {value: 600 N s/m, range: [200 N s/m, 2 kN s/m]}}\n"
    (tmp_path / "rig.yaml").write_text(RIG.replace(f"c: {C} N s/m", "c: c") + searched, encoding="utf-8")
    (trial,) = load_trials([run])
    space = SearchSpace(("c",), np.array([200.0]), np.array([2000.0]), np.array([600.0]))
    options = FitOptions(Nuisances(gain=0, clock=0), (0.5, 40.0))
    fit = fit_least_squares(Problem((trial,), space), space.unit(space.start), options, noises={trial.name: Noise(EVEN, sigma)})
    (name,), (found,) = fit.misfit.problem.space.names, fit.values
    assert (name, found) == ("c", pytest.approx(c, rel=1e-3))
    assert fit.chi2 < 1.5
    told = np.linalg.norm(linearise(fit.misfit, fit.x).jacobian[:, 0])
    monkeypatch.setattr(Trial, "fade_in", RAMP)
    faded = Misfit(fit.misfit.problem, fit.misfit.noises, space.start, options.nuisances, options.band)
    assert told > 4 * np.linalg.norm(linearise(faded, fit.x).jacobian[:, 0])
