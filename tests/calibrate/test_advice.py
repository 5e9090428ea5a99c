"""Sensitivities, sensor advice, validation, and where work runs."""

from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor
from multiprocessing import get_context

import numpy as np
import pytest
from threadpoolctl import threadpool_limits

from tests.fit.recordings import sedan_truth, write_run
from vehgen.calibrate.calibration import Settings, calibrate_problem
from vehgen.calibrate.genetic import GeneticSearch
from vehgen.calibrate.sensitivity import sensitivity
from vehgen.calibrate.sensor_placement import advise_sensors
from vehgen.calibrate.summary import summarise
from vehgen.calibrate.validation import validate
from vehgen.fit import processes
from vehgen.fit.parallel import Runner, runner_at
from vehgen.fit.problem import make_problem
from vehgen.fit.trial import load_trials
from vehgen.measure import record_psd
from vehgen.simulate import load_run
from vehgen.vehicle import load_vehicle

TRUCK = """vehicle: tractor5.yaml
set: sensitivity
speed: 2 m/s
duration: 11 s
road: [{hump: {shape: half_sine, length: 0.4 m, height: 0.04 m, at: 1 m}}]
sensors:
  L1: {body: tractor, behind: axle1, channels: {acceleration: L1}}
  L2: {body: semitrailer, behind: fifth_wheel, distance: 8.45 m, channels: {acceleration: L2}}
"""


@pytest.fixture(scope="module")
def truck(tmp_path_factory):
    path = tmp_path_factory.mktemp("truck") / "run.yaml"
    path.write_text(TRUCK, encoding="utf-8")
    return load_run(path)


@pytest.mark.thorough
def test_sensitivities_are_those_of_finite_differences(tmp_path):
    run = load_run(write_run(tmp_path, "hump", sedan_truth()))
    found = sensitivity(run, ["kr", "mf"])
    problem = make_problem(load_trials([tmp_path / "hump.yaml"]), ["mf", "kr"])
    for name in found.names:
        column = problem.space.names.index(name)
        step = 1e-4 * problem.space.start[column] * np.eye(2)[column]
        sides = problem.respond(np.array([problem.space.start + step, problem.space.start - step]), problem.trials[0])[0]
        difference = (sides[0] - sides[1]) / (2 * step[column])
        density = record_psd(difference, 0.01, axis=0)[1]
        # by Parseval's theorem a PSD's sum is the energy of its record, however long
        assert found.index[found.names.index(name)].sum(axis=1) == pytest.approx(density.sum(axis=0), rel=0.02)
        assert found.relative[found.names.index(name)] == pytest.approx(
            0.01 * problem.space.start[column] * np.sqrt(np.mean(difference**2, axis=0) / np.mean(sides.mean(axis=0) ** 2, axis=0)), rel=0.1
        )


@pytest.mark.thorough
def test_the_first_sensor_feels_axle_1_and_the_second_the_others_as_in_the_papers_figure_5(truck):
    found = sensitivity(truck)
    power = found.index.sum(axis=2) * found.values[:, None] ** 2
    for kind in ("m", "k", "c", "kt"):
        rows = np.array([power[found.names.index(f"{kind}{i}")] for i in range(1, 6)])
        assert rows[0, 0] > 10 * rows[3:, 0].max()
        assert rows[3:, 1].min() > 10 * rows[0, 1]


@pytest.mark.thorough
def test_two_sensors_go_to_the_front_of_the_tractor_and_the_rear_of_the_semitrailer(truck):
    found = advise_sensors(truck, 2)
    first, second = found.best[1].places
    assert {first.body, second.body} == {"tractor", "semitrailer"}
    front, rear = (first, second) if first.body == "tractor" else (second, first)
    assert front.x == pytest.approx(1.7, abs=0.6)
    assert rear.x < -2.4 + 0.6
    assert found.best[1].score < found.best[0].score


def test_no_more_sensors_are_placed_than_there_are_places(tmp_path):
    path = tmp_path / "run.yaml"
    path.write_text(TRUCK[: TRUCK.index("sensors:")].replace("tractor5.yaml\nset: sensitivity", "quarter_car"), encoding="utf-8")
    found = advise_sensors(path, 3)
    assert len(found.candidates) == 1
    assert [len(layout.places) for layout in found.best] == [1]


def test_a_vehicle_is_valid_on_its_own_recording_and_another_is_not(tmp_path):
    truth = sedan_truth()
    path = write_run(tmp_path, "hump", truth, noise=0.001)
    vehicle = load_vehicle("sedan2.yaml")
    own = load_run(path, vehicle)
    assert validate(vehicle, [path]).worst > 0.05
    text = path.read_text(encoding="utf-8")
    units = {"m": "kg", "I": "kg m^2", "k": "N/m", "c": "N s/m", "L": "m"}
    given = ", ".join(f"{name}: {value!r} {units[name[0]]}" for name, value in truth.items())
    path.write_text(f"parameters: {{{given}}}\n{text}", encoding="utf-8")
    found = validate(own.vehicle, [path])
    assert found.worst < 0.01
    assert {item.channel for item in found.channels} == {"F_az", "F_q", "R_az", "R_q"}


@pytest.fixture(scope="module")
def calibration(tmp_path_factory):
    problem = make_problem(load_trials([write_run(tmp_path_factory.mktemp("run"), "hump", sedan_truth())]))
    return calibrate_problem(problem, Settings(search=GeneticSearch(1, 10, 2), starts=2))


@pytest.fixture(scope="module")
def here(calibration):
    """The summary whose bootstrap runs in this process, one replicate after the other."""
    with threadpool_limits(1, user_api="blas"):
        return summarise(calibration, replicates=3)


def check_same(calibration, here, runner):
    with threadpool_limits(1, user_api="blas"):  # as `calibrate` has it: how many threads add up a sum shows in its last digits
        there = summarise(calibration, replicates=3, runner=runner)
    assert here.bootstrap
    assert here.bootstrap == there.bootstrap


@pytest.mark.thorough
def test_a_bootstrap_is_the_same_on_threads(calibration, here):
    with ThreadPoolExecutor(2) as pool:
        check_same(calibration, here, Runner(pool))


@pytest.mark.thorough
def test_a_bootstrap_is_the_same_in_other_processes(calibration, here):
    with ProcessPoolExecutor(2, mp_context=get_context("spawn")) as pool:
        check_same(calibration, here, Runner(pool))


@pytest.mark.slow
def test_a_bootstrap_is_the_same_in_processes_that_last(calibration, here, monkeypatch):
    monkeypatch.setattr(processes, "WORTH_PROCESSES_S", 0.0)
    with runner_at(None, 2) as runner:
        check_same(calibration, here, runner)
        check_same(calibration, here, runner)


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore")
def test_a_bootstrap_is_the_same_on_a_dask_cluster_that_loses_a_worker(calibration, here):
    distributed = pytest.importorskip("distributed")
    with (
        distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None, processes=True) as cluster,
        runner_at(cluster.scheduler_address) as runner,
    ):
        check_same(calibration, here, runner)
        next(iter(cluster.workers.values())).kill()
        check_same(calibration, here, runner)
