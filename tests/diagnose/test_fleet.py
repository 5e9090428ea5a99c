"""Fleets: a row for every vehicle, what is kept, and the same numbers wherever they are computed."""

import csv
import json
import os
import shutil
import time
from contextlib import nullcontext

import pytest

from tests.fit.recordings import sedan_truth, write_run
from vehgen.commands import main
from vehgen.diagnose import diagnose
from vehgen.diagnose.fleet import Fleet, FleetRow, diagnose_fleet, diagnosing, work
from vehgen.diagnose.fleet.layout import load_fleet_vehicle
from vehgen.diagnose.pipeline import diagnose_trials
from vehgen.errors import InputError
from vehgen.files.results import json_text, read_json
from vehgen.fit.parallel import Lost, Runner
from vehgen.vehicle import load_vehicle

BROKEN = {"bad_yaml": "not valid YAML", "empty": "holds no run file", "unlike": "name different vehicles"}


def only_result(found, folder, extends):
    """Return the files of a diagnosis without a page."""
    return found, {"diagnosis.json": json_text(found), "base.txt": extends}


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    """A fleet of two sedans, one of them with its own vehicle file over a shared one, and of three that cannot be read."""
    fleet = tmp_path_factory.mktemp("made") / "fleet"
    for name in ("first", "second", "_shared", *BROKEN):
        (fleet / name).mkdir(parents=True)
    write_run(fleet / "first", "hump", sedan_truth())
    write_run(fleet / "second", "hump", sedan_truth(2), seed=5)
    (fleet / "_shared" / "base.yaml").write_text("extends: sedan2\nname: base\n")
    (fleet / "second" / "vehicle.yaml").write_text("extends: ../_shared/base.yaml\nname: second_sedan\n")
    (fleet / "bad_yaml" / "run.yaml").write_text("vehicle: [")
    write_run(fleet / "unlike", "one", sedan_truth())
    (fleet / "unlike" / "other.yaml").write_text((fleet / "unlike" / "one.yaml").read_text().replace("sedan2", "tractor5"))
    (fleet / "notes.txt").write_text("no vehicle")
    return fleet


@pytest.fixture
def fleet(made, tmp_path):
    """A copy of it, which a test may change."""
    return shutil.copytree(made, tmp_path / "fleet")


@pytest.fixture(scope="module")
def once_each():
    """Diagnose a vehicle once: fleets of the same vehicles differ in what becomes of the verdict, not in the verdict."""
    made = {}

    def diagnose_once(trials, effects, everywhere):
        key = (trials[0].run.vehicle.name, *trials[0].values.items(), *(effect.name for effect in effects))
        if key not in made:
            made[key] = diagnose_trials(trials, effects, everywhere)
        return made[key]

    return diagnose_once


@pytest.fixture
def here(monkeypatch, once_each):
    """Compute in this process; returns the names of what was computed."""
    done = []
    monkeypatch.setattr(work, "diagnose_trials", once_each)

    class Here(Runner):
        def as_completed(self, function, inputs):
            for item, answer in super().as_completed(function, inputs):
                done.append(item.name)
                yield item, answer

    monkeypatch.setattr(diagnosing, "ProcessRunner", lambda processes: nullcontext(Here()))
    return done


def rows(found):
    return {row.name: row for row in found.rows}


def diagnosed(fleet, **options):
    return diagnose_fleet(fleet, fleet.parent / "out", files_of=only_result, effects=["dry_friction"], **options)


@pytest.fixture(scope="module")
def apart(made):
    """The fleet's diagnoses, each in a process of its own."""
    return diagnose_fleet(made, made.parent / "out", files_of=only_result, effects=["dry_friction"], processes=2)


@pytest.mark.slow
def test_every_vehicle_has_a_row_and_a_broken_one_stops_no_other(made, apart):
    found = rows(apart)
    assert list(found) == sorted(["first", "second", *BROKEN])
    for name, said in BROKEN.items():
        assert found[name].status == "failed"
        assert said in found[name].error
        assert "\n" not in found[name].error
    for name in ("first", "second"):
        alone = diagnose(load_vehicle("sedan2" if name == "first" else made / name / "vehicle.yaml"), made / name / "hump.yaml")
        assert found[name].verdict == alone.verdict
        assert read_json(made.parent / "out" / name / "diagnosis.json")["verdict"] == found[name].verdict.verdict
    assert (made.parent / "out" / "second" / "base.txt").read_text() == "../../fleet/second/vehicle.yaml"
    assert (made.parent / "out" / "first" / "base.txt").read_text() == "sedan2.yaml"
    assert {name for name, _ in found["second"].inputs} > {
        "second/vehicle.yaml",
        "_shared/base.yaml",
        "second/hump.yaml",
        "second/hump.csv",
    }
    assert Fleet.from_dict(json.loads(json_text(apart))) == apart
    columns, cells = apart.table()
    assert {len(row) for row in cells} == {len(columns)}


@pytest.mark.thorough
def test_what_is_finished_is_kept_while_its_inputs_stay_the_same(fleet, here):
    first = diagnosed(fleet)
    assert here == ["first", "second"]
    assert diagnosed(fleet) == first
    assert here == ["first", "second"]
    (fleet / "_shared" / "base.yaml").write_text("extends: sedan2\nname: base\nparameters: {mf: {value: 91 kg}}\n")
    diagnosed(fleet)
    assert here == ["first", "second", "second"]
    shutil.rmtree(fleet.parent / "out" / "first")
    diagnosed(fleet)
    assert here == ["first", "second", "second", "first"]
    diagnosed(fleet, everywhere=True)
    assert len(here) == 6
    (fleet.parent / "out" / "fleet.json").write_text("{}")
    diagnosed(fleet, everywhere=True)
    assert len(here) == 8


@pytest.mark.thorough
def test_ctrl_c_keeps_what_is_done(fleet, here):
    def stop(label, done, total, best):
        if best.startswith("first"):
            raise KeyboardInterrupt

    stopped = diagnosed(fleet, progress=stop)
    assert stopped.stopped
    assert {name: row.status for name, row in rows(stopped).items()} == {
        "first": "finished",
        "second": "waiting",
        "bad_yaml": "failed",
        "empty": "failed",
        "unlike": "failed",  # told before the first diagnosis
    }
    again = diagnosed(fleet)
    assert here == ["first", "second"]
    assert rows(again)["first"] == rows(stopped)["first"]
    assert not again.stopped


def test_a_fault_or_a_lost_worker_is_a_row(fleet, monkeypatch):
    class Breaking(Runner):
        def as_completed(self, function, inputs):
            for number, item in enumerate(inputs):
                yield item, Lost("its worker is gone") if number else function(item)

    def break_down(*_):
        raise ZeroDivisionError("a fault")

    monkeypatch.setattr(diagnosing, "ProcessRunner", lambda processes: nullcontext(Breaking()))
    monkeypatch.setattr(work, "diagnose_trials", break_down)
    found = rows(diagnosed(fleet))
    assert found["first"].error.startswith("internal fault: ZeroDivisionError: a fault")
    assert found["second"].error == "its worker is gone"


@pytest.mark.thorough
def test_a_fault_while_one_vehicle_is_read_is_its_row(fleet, here, monkeypatch):
    def breaking(folder):
        if folder.name == "first":
            raise RecursionError("too deep,\nfar too deep")
        return load_fleet_vehicle(folder)

    monkeypatch.setattr(diagnosing, "load_fleet_vehicle", breaking)
    found = rows(diagnosed(fleet))
    assert found["first"].status == "failed"
    assert found["first"].error == "internal fault: RecursionError: too deep, far too deep (please report it)"
    assert found["second"].status == "finished"


@pytest.mark.thorough
def test_names_that_are_not_utf_8_fail_alone(fleet, here):
    for vehicle, name in ((b"caf\xe9", b"hump.yaml"), (b"named", b"h\xfcmp.yaml")):
        folder = os.path.join(os.fsencode(fleet), vehicle)
        try:
            os.mkdir(folder)
        except OSError:
            pytest.skip("this file system has no such names")
        with open(os.path.join(folder, name), "wb") as file:
            file.write((fleet / "first" / "hump.yaml").read_bytes())
    found = rows(diagnosed(fleet))
    assert found["caf\\udce9"].status == found["named"].status == "failed"
    assert found["caf\\udce9"].error == "the name 'caf\\udce9' is not UTF-8, and no result can tell it; rename it"
    assert "'h\\udcfcmp.yaml' is not UTF-8" in found["named"].error
    assert found["first"].status == found["second"].status == "finished"
    assert "caf\\udce9" in (fleet.parent / "out" / "fleet.csv").read_text(encoding="utf-8")


def test_names_that_a_spreadsheet_would_run_are_text(fleet, here):
    for name in ("=1+1", "@SUM(1)", "-2", "+3"):
        (fleet / name).mkdir()
    found = diagnosed(fleet)
    with (fleet.parent / "out" / "fleet.csv").open(newline="", encoding="utf-8") as table:
        names = {row["vehicle"] for row in csv.DictReader(table)}
    assert names == {"'=1+1", "'@SUM(1)", "'-2", "'+3", "first", "second", *BROKEN}
    assert "=1+1" in rows(found)


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore")
def test_a_cluster_that_loses_a_worker_finds_the_same(fleet, apart):
    distributed = pytest.importorskip("distributed")
    killed = []
    with distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None, processes=True) as cluster:

        def kill(label, done, total, best):
            if best.startswith("unlike"):  # read after the others were sent off
                while not all(worker.processing for worker in cluster.scheduler.workers.values()):
                    time.sleep(0.01)
                killed.append([task.key for worker in cluster.scheduler.workers.values() for task in worker.processing])
                next(iter(cluster.workers.values())).kill()

        found = diagnosed(fleet, scheduler=cluster.scheduler_address, progress=kill)
    assert [len(keys) for keys in killed] == [2]
    assert [(row.name, row.status, row.verdict, row.inputs) for row in found.rows] == [
        (row.name, row.status, row.verdict, row.inputs) for row in apart.rows
    ]


@pytest.mark.thorough
def test_own_effects_travel_as_text(fleet, here):
    own = fleet.parent / "own.yaml"
    parameter = "{k3: {unit: N/m^3, low: 1e4, high: 1e9, starts: [1e7], meaning: cubic stiffness}}"
    own.write_text(f"effects:\n  stiff: {{title: Stiff, meaning: stiff, attaches: suspension, force: k3*d^3, parameters: {parameter}}}\n")
    found = diagnose_fleet(fleet, fleet.parent / "out", files_of=only_result, effects=["stiff"], library=[own])
    assert here == ["first", "second"]
    assert rows(found)["first"].status == "finished"


@pytest.mark.parametrize(
    ("where", "said"),
    [("nowhere", "cannot read the folder"), ("fleet/empty", "holds no vehicle"), ("fleet/first/hump.csv", "cannot read the folder")],
)
def test_a_folder_without_vehicles_is_refused(fleet, where, said):
    with pytest.raises(InputError, match=said):
        diagnose_fleet(fleet.parent / where, fleet.parent / "out", files_of=only_result)


def test_the_result_must_stand_outside(fleet):
    with pytest.raises(InputError, match="a folder outside of"):
        diagnose_fleet(fleet, fleet / "out", files_of=only_result)


def test_a_run_that_names_no_vehicle_is_refused_at_its_place(fleet):
    (fleet / "empty" / "run.yaml").write_text("vehicle: no_such_vehicle.yaml\n")
    with pytest.raises(InputError, match=r"run.yaml:1:10: .*no_such_vehicle"):
        load_fleet_vehicle(fleet / "empty")


@pytest.mark.thorough
def test_the_page_is_drawn_again_and_quotes_what_strangers_wrote(apart, tmp_path):
    hostile = FleetRow("<b>&", "failed", error="<script>")
    (tmp_path / "fleet.json").write_text(json_text(Fleet(apart.fleet, (*apart.rows, hostile), apart.made_by)))
    assert main(["report", str(tmp_path / "fleet.json"), "--out", str(tmp_path / "again")]) == 0
    page = (tmp_path / "again" / "index.html").read_text(encoding="utf-8")
    assert 'href="first/report.html"' in page
    assert page.count("<script") == 1
    assert "<b>" not in page
    assert page.count("<tr>") == len(apart.rows) + 2
