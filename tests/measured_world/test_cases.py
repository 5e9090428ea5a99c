"""Drawn cases, mistakes, files, exports and how answers are judged."""

import ast
import csv
import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from benchmarks import measured_world
from benchmarks.hidden_effects.generator.cases import Effect
from benchmarks.measured_world import accepted, score, solve
from benchmarks.measured_world.cases import Recording
from benchmarks.measured_world.faults import FAULTS, spoilt, with_fault
from benchmarks.measured_world.make import write_case
from benchmarks.measured_world.page import page
from benchmarks.measured_world.roads import Profile
from benchmarks.measured_world.sets import draw_case
from benchmarks.measured_world.world import drive_past, record_run, strength

import vehgen

SOLVERS = {"solve.py"}
TELLING = "telling"


@pytest.fixture(scope="module")
def healthy():
    return draw_case("trial", 3, "healthy", 0, "logger")


@pytest.fixture(scope="module")
def recordings(healthy):
    """Stand-ins of the runs' recordings: another random number everywhere."""
    random = np.random.default_rng(1)
    t = np.arange(800) / 100.0
    found = []
    for run in healthy.runs:
        channels = {f"{sensor.name}_{quantity}": random.standard_normal(len(t)) for sensor in healthy.sensors for quantity in ("az", "q")}
        profile = None if run.road is None else Profile(np.arange(5.0), np.zeros(5))
        found.append(Recording(run, 5.0, t, channels, channels, dict.fromkeys(channels, 0.01), profile))
    return found


def test_only_the_solver_imports_vehgen():
    """And what asks, with the truth at hand, whether a miss could have been told: the generators import neither."""
    for path in Path(measured_world.__file__).parent.rglob("*.py"):
        nodes = ast.walk(ast.parse(path.read_text(encoding="utf-8")))
        names = {alias.name for node in nodes if isinstance(node, ast.Import) for alias in node.names}
        names |= {node.module or "" for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))) if isinstance(node, ast.ImportFrom)}
        assert path.name == "__main__.py" or path.parent.name == TELLING or not any(TELLING in name for name in names), path
        if path.parent.name == TELLING:
            continue
        found = {name for name in names if name.split(".")[0] == "vehgen"}
        assert found <= ({"vehgen"} if path.name in SOLVERS else set()), path


def test_a_case_depends_on_set_seed_kind_and_number_alone(healthy):
    assert draw_case("trial", 3, "healthy", 0, "logger") == healthy
    assert draw_case("sealed", 3, "healthy", 0, "logger").parameters != healthy.parameters
    with pytest.raises(ValueError, match="odd"):
        draw_case("trial", 3, "odd", 0)


def test_a_healthy_vehicle_keeps_its_tyres_on_the_road_and_stated_speeds_are_half_to_two_percent_off(healthy):
    for run in healthy.runs:
        assert 0.0049 < abs(run.true_speed / run.speed - 1.0) < 0.0201
        assert record_run(healthy, run).facts["lowest_tyre_load"] >= -0.01


def test_a_recording_begins_where_the_mark_is_or_a_fixed_time_before(healthy):
    run = replace(healthy.runs[0], start_error=0.0, timed=False)
    marked = drive_past(healthy, run)
    assert marked.drive.distance(np.array([marked.start]))[0] == pytest.approx(-marked.at)
    assert drive_past(healthy, replace(run, timed=True)).start == pytest.approx(-run.lead)


def test_a_case_without_effects_has_no_strength(healthy):
    assert strength(replace(healthy, runs=healthy.runs[:1])) == 0.0


def test_the_strength_of_a_wrong_gain_is_its_share_of_the_signal_over_the_noise(healthy):
    case = replace(healthy, runs=healthy.runs[:1], effects=(Effect("sensor_gain", "F_az", {"error": 0.2}),))
    bare = record_run(replace(case, effects=()), case.runs[0])
    signal = np.sqrt(np.mean(bare.clean["F_az"] ** 2))
    assert strength(case) == pytest.approx(0.2 * signal / bare.sigma["F_az"] / np.sqrt(4))


def test_loggers_files_can_be_read_and_simulated(healthy, tmp_path):
    case = replace(healthy, runs=healthy.runs[:1])
    write_case(case, tmp_path)
    folder = tmp_path / "cases" / case.name
    run = folder / f"{case.runs[0].name}.yaml"
    response = vehgen.simulate(run)
    with run.with_suffix(".csv").open() as stream:
        header = next(csv.reader(stream))
    assert header == ["t", *(channel.name for channel in response.channels)]
    truth = json.loads((tmp_path / "truth" / case.name / "truth.json").read_text())
    assert truth["fault"] is None
    assert truth["effects"] == []
    assert not list(folder.rglob("truth*"))


@pytest.mark.thorough
def test_phones_exports_can_be_imported_and_tell_what_was_measured(tmp_path):
    case = draw_case("trial", 3, "healthy", 0, "phones")
    case = replace(case, runs=case.runs[:1])
    write_case(case, tmp_path)
    folder = tmp_path / "cases" / case.name
    runs, refused = solve.imported(folder)
    assert refused == {}
    facts = json.loads((tmp_path / "truth" / case.name / "truth.json").read_text())["runs"][0]["facts"]
    response = vehgen.simulate(runs[0])
    table = np.genfromtxt(runs[0].with_name(f"{runs[0].stem}_recording.csv"), delimiter=",", names=True)
    for name in table.dtype.names[1:]:
        shifted = (np.interp(table["t"] - late, response.time, np.ravel(response.channel(name))) for late in np.arange(-0.08, 0.08, 0.005))
        assert max(np.corrcoef(simulated, table[name])[0, 1] for simulated in shifted) > 0.9
    told = next(line for line in runs[0].read_text().splitlines() if line.startswith("speed:"))
    assert float(told.split()[1]) == pytest.approx(facts["mean_speed"], rel=0.1)


@pytest.mark.parametrize("kind", list(FAULTS))
def test_every_mistake_changes_what_is_written_or_recorded_and_says_where(kind, healthy, recordings):
    random = np.random.default_rng(5)
    case = with_fault(healthy, kind, random)
    assert case.fault.kind == kind
    assert set(case.fault.runs) <= {run.name for run in case.runs}
    changed = spoilt(case, [replace(item, run=run) for item, run in zip(recordings, case.runs, strict=True)])
    planned = any(getattr(case, name) != getattr(healthy, name) for name in ("runs", "logger", "stated"))
    recorded = any(
        len(one.t) != len(other.t)
        or one.profile is not other.profile
        or any(np.any(one.channels[name] != other.channels[name]) for name in one.channels)
        for one, other in zip(changed, recordings, strict=True)
    )
    assert planned or recorded


def test_units_signs_and_exchanges_are_what_they_say(healthy, recordings):
    for kind, expected in (("unit_g", 1 / 9.81), ("unit_degrees", 180 / np.pi), ("sign_reversed", -1.0)):
        case = with_fault(healthy, kind, np.random.default_rng(2))
        (item,) = case.fault.items
        changed = spoilt(case, recordings)
        for one, other in zip(changed, recordings, strict=True):
            assert one.channels[item] == pytest.approx(expected * other.channels[item])
            assert all(one.channels[name] is other.channels[name] for name in one.channels if name != item)
    case = with_fault(healthy, "sensors_exchanged", np.random.default_rng(2))
    one, other = spoilt(case, recordings)[0], recordings[0]
    assert one.channels["F_q"] is other.channels["R_q"]
    assert one.channels["R_az"] is other.channels["F_az"]


def test_clocks_apart_shift_one_sensor_against_the_other(healthy, recordings):
    case = with_fault(healthy, "clocks_apart", np.random.default_rng(2))
    one, other = spoilt(case, recordings)[0], recordings[0]
    n = round(case.fault.size * 100)
    assert 20 <= n <= 200
    assert np.array_equal(one.channels["F_az"], other.channels["F_az"][n:])
    assert np.array_equal(one.channels["R_az"], other.channels["R_az"][:-n])
    assert other.at - one.at == pytest.approx(n / 100 * other.run.speed, abs=1e-3)


def test_a_wrong_speed_leaves_the_pass_and_the_mark_as_they_were(healthy):
    case = with_fault(
        replace(healthy, runs=tuple(replace(run, timed=False) for run in healthy.runs)), "speed_unit", np.random.default_rng(2)
    )
    name = case.fault.runs[0]
    before, after = (next(run for run in item.runs if run.name == name) for item in (healthy, case))
    assert after.speed / before.speed == pytest.approx(3.6, abs=0.01)
    assert after.true_speed == before.true_speed
    one, other = drive_past(healthy, replace(before, timed=False)), drive_past(case, after)
    assert (one.at, one.end - one.start) == pytest.approx((other.at, other.end - other.start), abs=0.11)


def test_a_wrong_wheelbase_is_stated_in_the_vehicle_file(healthy, tmp_path):
    case = replace(with_fault(healthy, "wheelbase", np.random.default_rng(2)), runs=())
    write_case(case, tmp_path)
    stated = vehgen.load_vehicle(tmp_path / "cases" / case.name / "sedan2.yaml").parameters["wheelbase"]
    assert 0.15 < abs(case.stated["wheelbase"] - case.parameters["wheelbase"]) < 0.55
    assert str(case.stated["wheelbase"]) in str(stated)


HIDDEN = [{"name": "dry_friction", "place": "rear"}]
FAULT = {"kind": "clocks_apart", "runs": ["low"], "items": ["F", "R"], "size": 0.5}


@pytest.mark.parametrize(
    ("answer", "expected"),
    [
        ({"verdict": "named", "effects": [{"name": "dry_friction", "place": "rear"}]}, "named right"),
        ({"verdict": "named", "effects": [{"name": "dry_friction", "place": "front"}]}, "named right, elsewhere"),
        ({"verdict": "named", "effects": [{"name": "bump_stop", "place": "rear"}]}, "named wrong"),
        ({"verdict": "ambiguous", "effects": [*HIDDEN, {"name": "hysteresis", "place": "rear"}]}, "ambiguous, truth among them"),
        ({"verdict": "crash"}, "crash"),
    ],
)
def test_answers_on_effects_are_counted(answer, expected):
    assert accepted.judged_effect(HIDDEN, answer) == expected


@pytest.mark.parametrize(
    ("answer", "expected"),
    [
        ({"verdict": "measurement_fault", "faults": [{"kind": "clocks_apart", "runs": ["low"]}]}, "fault named right, place too"),
        ({"verdict": "measurement_fault", "faults": [{"kind": "unit", "run": "low"}]}, "another fault named"),
        ({"verdict": "refused", "reason": "the sensors' clocks differ"}, "refused, fault told"),
        ({"verdict": "named", "effects": [{"name": "sensor_delay", "place": "F"}]}, "named as an effect that describes it"),
        ({"verdict": "named", "effects": HIDDEN}, "named as a false effect"),
    ],
)
def test_answers_on_mistakes_are_counted(answer, expected):
    assert accepted.judged_fault(FAULT, answer) == expected


def test_tables_of_accepted_names_hold_every_mistake():
    assert set(accepted.KINDS) == set(accepted.WORDS) == set(FAULTS)


def test_a_crash_of_the_solver_is_recorded_and_the_page_counts_it(tmp_path):
    truth = {"case": "x", "kind": "effects", "vehicle": "sedan2", "recorder": "logger", "effects": HIDDEN, "fault": None}
    (tmp_path / "truth" / "x").mkdir(parents=True)
    (tmp_path / "truth" / "x" / "truth.json").write_text(json.dumps(truth))
    out = tmp_path / "results.jsonl"
    for _ in range(2):
        score.score_set(tmp_path, out, 1, None, 60.0, {})
    (record,) = [json.loads(line) for line in out.read_text().splitlines()]
    assert record["judged"] == "crash"
    assert "No such file" in record["answer"]["reason"]
    assert "| crash | 1 | 1 |" in page([record])


def test_intervals_are_counted_by_family():
    truth = {"vehicle": "sedan2", "invariants": {"kf": 10.0, "Lf": 1.0}, "modes": [{"frequency": 1.0, "damping_ratio": 0.2}]}
    mode = {"undamped_hz": 1.1, "interval": [0.9, 1.3], "damping_ratio": 0.3, "damping_interval": [0.25, 0.35]}
    answer = {"combinations": {}, "parameters": {"kf": {"value": 11.0, "interval": [9.0, 13.0]}, "Lf": {"value": 1.0, "interval": None}}}
    found = score.rows(truth, {**answer, "modes": [mode]})
    assert [row["family"] for row in found] == [
        "suspension stiffnesses", "distances and inertias", "body modes, frequency", "body modes, damping ratio"
    ]  # fmt: skip
    assert [score.family(name) for name in ("ktf", "kt3/(mT + mS)", "IZ", "b7/(mT + mS)", "m1/(mT + mS)", "mf")] == [
        "tyre stiffnesses", "tyre stiffnesses", "distances and inertias", "distances and inertias", "unsprung masses", "unsprung masses"
    ]  # fmt: skip
    record = {"kind": "coverage", "vehicle": "sedan2", "recorder": "logger", "rows": found, "answer": {"outcome": "calibrated"}}
    assert "| suspension stiffnesses | 1 | 0 | 100 (2 to 100) | 20.00 | 10.00 | 0.50 |" in page([record])
