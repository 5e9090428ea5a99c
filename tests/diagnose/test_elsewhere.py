"""Places tested and candidates fitted in other processes, or on a cluster: the diagnosis is the same, bit for bit."""

import pickle
import subprocess
import sys
from dataclasses import replace

import pytest
from benchmarks.hidden_effects.generator import Effect

from tests.diagnose.conftest import CUBIC, HUMPS
from vehgen.diagnose import api, diagnose
from vehgen.diagnose.pipeline import diagnose_trials
from vehgen.effects import EFFECTS, load_effects
from vehgen.fit import processes
from vehgen.fit.parallel import Runner, can_be_sent

TRIED = ("cubic_stiffness",)
FRICTION = Effect("dry_friction", "rear", {"force": 450.0})


class Sent(Runner):
    """Does each piece of work on copies, as another process gets them, and gives a copy of what comes of it; counts the pieces."""

    sent = 0

    def map(self, function, inputs):
        """Yield the function's values."""
        for item in inputs:
            there, work = pickle.loads(pickle.dumps((function, item)))
            type(self).sent += 1
            yield pickle.loads(pickle.dumps(there(work)))


@pytest.fixture(scope="module")
def here(trials_of):
    """The verdict on a hidden spring, all done in this process."""
    return diagnose_trials(trials_of(CUBIC, runs=HUMPS), [EFFECTS[name] for name in TRIED]).verdict.to_dict()


@pytest.mark.thorough
def test_what_is_sent_to_and_fro_finds_the_same(trials_of, here):
    found = diagnose_trials(trials_of(CUBIC, runs=HUMPS), [EFFECTS[name] for name in TRIED], runner=Sent())
    assert found.verdict.to_dict() == here
    assert here["verdict"] == "named"
    assert found.chosen[-1].last.effect is EFFECTS["cubic_stiffness"]  # not a copy, whose functions are others
    assert Sent.sent > 10  # places, candidates, the best fitted again


@pytest.mark.slow
def test_friction_restarted_elsewhere_is_the_same(trials_of):
    trials, effects = trials_of(FRICTION, runs=HUMPS), [EFFECTS["dry_friction"]]
    own, sent = (diagnose_trials(trials, effects, runner=runner).verdict.to_dict() for runner in (Runner(), Sent()))
    assert own == sent


@pytest.mark.slow
def test_processes_find_the_same(record, here, monkeypatch):
    monkeypatch.setattr(processes, "WORTH_PROCESSES_S", 0.0)
    found = diagnose("sedan2", record(CUBIC, runs=HUMPS), effects=TRIED, workers=2)
    assert found.verdict.to_dict() == here


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore")
def test_a_cluster_finds_the_same(record, here):
    distributed = pytest.importorskip("distributed")
    with distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None, processes=True) as cluster:
        found = diagnose("sedan2", record(CUBIC, runs=HUMPS), effects=TRIED, scheduler=cluster.scheduler_address)
    assert found.verdict.to_dict() == here


def test_effects_that_cannot_be_sent_are_fitted_here(record, monkeypatch):
    asked = []
    monkeypatch.setattr(api, "diagnose_trials", lambda *arguments: asked.append(arguments[-1]))
    own = replace(EFFECTS["cubic_stiffness"], name="own", edit=lambda site, symbols: {})
    for effect in (own, "cubic_stiffness"):
        diagnose("sedan2", record(CUBIC, runs=HUMPS), effects=[effect], workers=2)
    assert [type(runner) for runner in asked] == [Runner, processes.ProcessRunner]


def test_effects_of_the_library_and_of_files_can_be_sent(tmp_path):
    assert can_be_sent(EFFECTS)
    assert not can_be_sent(lambda: None)
    parameters = "{k3: {unit: N/m^3, low: 0.01, high: 30, starts: [1], times: k/travel^2, meaning: c}}"
    for kind in ("force: k3*d^3", "law: {cubic_stiffness: {k3: k3}}"):
        file = tmp_path / f"{len(kind)}.yaml"
        file.write_text(f"effects:\n  own: {{title: A, meaning: b, attaches: suspension, {kind}, parameters: {parameters}}}\n")
        assert can_be_sent(load_effects(file))


def test_what_a_notebooks_cell_defines_stays_where_it_is(tmp_path):
    code = "from vehgen.fit.parallel import can_be_sent\ndef own(): pass\nprint(can_be_sent(own), can_be_sent(can_be_sent))\n"
    script = tmp_path / "script.py"
    script.write_text(code, encoding="utf-8")
    told = [subprocess.run([sys.executable, *item], input=code, capture_output=True, encoding="utf-8") for item in ((), (str(script),))]
    assert [item.stdout.split() for item in told] == [["False", "True"], ["True", "True"]]
