"""Calibration of a sedan against recordings made by other means."""

from dataclasses import replace

import numpy as np
import pytest
import scipy.stats

import vehgen
from tests.fit.recordings import sedan_truth, write_run
from vehgen.calibrate.calibration import Settings, calibrate_problem, fingerprint
from vehgen.calibrate.genetic import GeneticSearch
from vehgen.calibrate.identifiability import find_structure
from vehgen.calibrate.intervals import Uncertainty
from vehgen.calibrate.methods import plan
from vehgen.calibrate.objective import PsdObjective
from vehgen.calibrate.summary import summarise
from vehgen.errors import InputError
from vehgen.fit.least_squares import fit_least_squares
from vehgen.fit.problem import make_problem
from vehgen.fit.trial import load_trials

TRUTH = sedan_truth()


@pytest.fixture(scope="module")
def problem(tmp_path_factory):
    folder = tmp_path_factory.mktemp("runs")
    return make_problem(load_trials([write_run(folder, "slow", TRUTH, 1.5), write_run(folder, "fast", TRUTH, 2.5, seed=1)]))


def small(method="joint", **more):
    return Settings(method=method, search=GeneticSearch(2, 30, 20), starts=2, **more)


def truth_of(problem):
    return np.array([TRUTH[name] for name in problem.space.names])


def test_the_objective_is_equation_5(problem):
    values = truth_of(problem)
    terms = PsdObjective(problem, (0.3, 40.0)).terms(values[None])[0]
    trial = problem.trials[0]
    simulated = problem.respond(values[None], trial)[0][0][:, 0]
    n, dt = len(simulated), trial.recording.dt
    power = [np.abs(np.fft.rfft(item)) ** 2 for item in (simulated, trial.recording.values[:, 0])]
    f = np.fft.rfftfreq(n, dt)
    inside = (f >= 0.3) & (f <= 40.0)
    assert terms[0] == pytest.approx(np.abs(power[0] - power[1])[inside].sum() / power[1][inside].sum(), rel=1e-9)
    assert (terms < 0.02).all()


@pytest.mark.parametrize("band", [(0.3, 40.0), (0.0, 50.0)])
def test_a_search_ranks_by_equation_5_in_single_precision(problem, band):
    objective = PsdObjective(problem, band)
    unit = np.random.default_rng(5).random((200, problem.space.size))
    exact, quick = objective(unit), objective.quick(unit)
    np.testing.assert_allclose(quick, exact, rtol=2e-5)
    assert (quick != exact).any()
    best = np.argsort(exact)[:100]
    assert scipy.stats.spearmanr(exact[best], quick[best]).statistic > 0.9999


@pytest.mark.slow
def test_what_a_calibration_tells_is_of_double_precision(problem):
    found = calibrate_problem(problem, small())
    again = calibrate_problem(problem, small())
    (step,) = found.steps
    objective, state, fit = PsdObjective(problem), step.state, step.fits[0]
    assert state.elite_objective == objective(state.elite[None])[0] != objective.quick(np.repeat(state.elite[None], 40, axis=0))[0]
    residuals = fit.misfit.residuals(fit.x)
    assert residuals.dtype == np.float64
    assert fit.chi2 == pytest.approx(np.mean(residuals**2), rel=1e-12)
    assert state.history == again.steps[0].state.history
    assert found.values == again.values


def test_an_individual_that_cannot_be_simulated_has_an_infinite_objective(problem):
    values = np.vstack([truth_of(problem)] * 2)
    values[0, 0] = np.nan
    found = PsdObjective(problem).terms(values).sum(axis=1)
    assert np.isinf(found[0])
    assert np.isfinite(found[1])
    points = np.full((40, problem.space.size), 0.5)
    points[7, 0] = np.nan
    assert np.flatnonzero(np.isinf(PsdObjective(problem).quick(points))).tolist() == [7]


@pytest.mark.thorough
def test_a_joint_fit_finds_the_truth_within_its_intervals(problem):
    found = calibrate_problem(problem, small())
    outcome = summarise(found, combinations=("kf/mf",))
    assert found.array == pytest.approx(truth_of(problem), rel=0.02)
    covered = [item.interval[0] <= TRUTH[name] <= item.interval[1] for name, item in outcome.parameters.items()]
    assert np.mean(covered) >= 0.7
    assert all(item.status == "identified" for item in outcome.parameters.values())
    assert outcome.combinations["kf/mf"].value == pytest.approx(TRUTH["kf"] / TRUTH["mf"], rel=0.02)
    assert found.steps[0].fits[0].chi2 == pytest.approx(1.0, abs=0.1)


@pytest.mark.parametrize(("method", "sensors"), [("shcm", ("F",)), pytest.param("dhcm", ("F", "R"), marks=pytest.mark.thorough)])
def test_the_papers_methods_find_the_truth_too(problem, method, sensors):
    found = calibrate_problem(problem, small(method, sensors=sensors))
    assert found.array == pytest.approx(truth_of(problem), rel=0.05)
    assert len(found.steps) == (2 if method == "dhcm" else 1)


def test_dhcm_keeps_the_first_axle_from_the_first_sensor(problem):
    first, second = plan(problem, "dhcm")
    assert first.sensors == ("F",)
    assert first.kept == ("mf", "IZ", "kf", "cf", "ktf")
    assert second.searched == ("Lf", "mr", "kr", "cr", "ktr")


@pytest.mark.parametrize(
    ("method", "sensors", "frozen", "said"),
    [
        ("shmc", (), (), "did you mean 'shcm'"),
        ("shcm", (), (), "uses one sensor"),
        ("dhcm", ("F",), (), "uses two sensors"),
        ("joint", ("G",), (), "no run has a sensor 'G'"),
        ("dhcm", (), ("mH",), "'mH' is not searched"),
    ],
)
def test_plans_that_cannot_work_are_refused(problem, method, sensors, frozen, said):
    with pytest.raises(InputError, match=said):
        plan(problem, method, sensors, frozen)


def test_the_same_seed_gives_the_same_result_bit_for_bit(problem):
    first, second = (calibrate_problem(problem, small(polish=False)) for _ in range(2))
    assert first.values == second.values
    assert first.values != calibrate_problem(problem, small(polish=False, seed=2)).values


def test_a_stopped_search_is_resumed_bit_for_bit(problem, tmp_path):
    whole = calibrate_problem(problem, small("dhcm", polish=False))
    path = tmp_path / "search.json"

    def stop(label, done, total, best):
        if label == "sensor R" and done == 13:
            raise KeyboardInterrupt

    part = calibrate_problem(problem, small("dhcm", polish=False), progress=stop, checkpoint=path)
    assert part.stopped
    assert set(part.values) == set(whole.values)
    again = calibrate_problem(problem, small("dhcm", polish=False), checkpoint=path, resume=True)
    assert again.values == whole.values
    with pytest.raises(InputError, match="another calibration"):
        calibrate_problem(problem, small("dhcm", polish=False, seed=9), checkpoint=path, resume=True)
    path.write_text("{", encoding="utf-8")
    with pytest.raises(InputError, match="not a checkpoint"):
        calibrate_problem(problem, small(), checkpoint=path, resume=True)


@pytest.mark.slow
def test_a_polish_takes_over_from_a_search_that_has_settled_and_finds_the_same(problem):
    settings = Settings(search=GeneticSearch(1, 30, 300), starts=2)
    early, whole = calibrate_problem(problem, settings), calibrate_problem(problem, replace(settings, polish=False))
    last = early.steps[0].state
    assert last.is_settled
    assert 50 <= last.generation < whole.steps[0].state.generation == 300
    assert not any(replace(last, history=last.history[:n]).is_settled for n in range(51, last.generation + 1))
    same = problem.with_trials(early.steps[0].recorder.applied(problem.trials))  # of low-passes that do as well it may suppose another
    assert early.array == pytest.approx(calibrate_problem(same, small()).array, rel=1e-3)


@pytest.mark.slow
def test_fisher_intervals_agree_with_a_bootstrap(problem):
    found = calibrate_problem(problem, Settings(search=GeneticSearch(1, 10, 0), starts=2))
    outcome = summarise(found, replicates=60)
    widths = [np.ptp(outcome.bootstrap[f"{mode.name} [Hz]"].interval) / np.ptp(mode.interval) for mode in outcome.modes]
    assert 0.75 < np.median(widths) < 1.3


@pytest.mark.slow
def test_intervals_cover_the_truth_over_a_rough_road(tmp_path):
    covered = []
    for seed in range(6):
        runs = [write_run(tmp_path, f"r{seed}{speed}", TRUTH, speed, seed=10 * seed + int(speed), rough=4e-4) for speed in (1.5, 2.5)]
        problem = make_problem(load_trials(runs))
        fit = fit_least_squares(problem, problem.space.unit(problem.space.start))
        known = Uncertainty(fit, find_structure(problem, fit.values))
        covered += [item.covers(TRUTH[item.name]) for item in known.parameters()]
    assert 0.75 <= np.mean(covered) <= 1.0


def test_the_vehicle_file_that_comes_out_is_read_back_exactly(problem, tmp_path):
    from vehgen.vehicle import load_vehicle

    outcome = summarise(calibrate_problem(problem, small(polish=False)))
    path = tmp_path / "sedan2_calibrated.yaml"
    path.write_text(outcome.vehicle_text(tmp_path, "sedan2_calibrated"), encoding="utf-8")
    values = load_vehicle(path).values()
    assert {name: values[name] for name in outcome.calibration.values} == outcome.calibration.values
    assert load_vehicle(path).ranges() == problem.trials[0].run.vehicle.ranges()


def test_runs_are_calibrated_jointly_by_the_sensors_that_each_has(tmp_path):
    both, one = write_run(tmp_path, "both", TRUTH, 2.5), write_run(tmp_path, "one", TRUTH, 3.0, seed=1)
    lines = one.read_text(encoding="utf-8").splitlines()
    one.write_text("\n".join(line for line in lines if not line.strip().startswith("R:")) + "\n", encoding="utf-8")
    found = calibrate_problem(make_problem(load_trials([both, one])), Settings(search=GeneticSearch(1, 10, 1), polish=False))
    channels = [trial.channels for trial in found.problem.trials]
    assert channels == [("F_az", "F_q", "R_az", "R_q"), ("F_az", "F_q")]


def test_a_checkpoint_is_of_the_files_that_were_read(tmp_path):
    run = write_run(tmp_path, "run", TRUTH, 2.5)
    drawn = "{shape: points, file: hump.csv, distance: s, height_column: h, at: 4 m}"
    text = run.read_text(encoding="utf-8")
    start = text.index("{shape: half_sine")
    run.write_text(text[:start] + drawn + text[text.index("}", start) + 1 :], encoding="utf-8")
    found = set()
    for height in (0.03, 0.06, 0.03):
        s = np.linspace(0, 0.5, 26)
        hump = np.column_stack([s, height * np.sin(np.pi * s / 0.5)])
        np.savetxt(tmp_path / "hump.csv", hump, delimiter=",", header="s,h", comments="")
        found.add(fingerprint(make_problem(load_trials([run])), small()))
    assert len(found) == 2


@pytest.mark.parametrize(("asked", "told"), [("k_f/mH", "which sedan2 does not have"), ("kf/(ktf-ktf)", "has no value")])
def test_a_combination_that_cannot_be_is_told_before_the_search(tmp_path, asked, told):
    steps = []
    with pytest.raises(InputError, match=told):
        vehgen.calibrate(
            "sedan2", [write_run(tmp_path, "run", TRUTH, 2.5)], combinations=[asked], progress=lambda *step: steps.append(step)
        )
    assert not steps


def test_a_recording_that_is_given_twice_is_refused(tmp_path):
    run = write_run(tmp_path, "run", TRUTH, 2.5)
    (tmp_path / "again.yaml").write_text(run.read_text(encoding="utf-8"), encoding="utf-8")
    with pytest.raises(InputError, match="run and again are one recording"):
        vehgen.calibrate("sedan2", [run, tmp_path / "again.yaml"])
