"""Recordings of the independent generator, detections and a written diagnosis: values that several tests share, made once each."""

import contextlib
import io
import json
from dataclasses import replace

import pytest
from benchmarks.hidden_effects.generator import Case, Effect, Hump, RandomRoad, RunSpec, write_case

from vehgen.commands import main
from vehgen.diagnose.detect.detection import detect
from vehgen.fit.trial import load_trials

RUNS = (
    RunSpec((Hump(0.5, 0.03, 4.0),), 2.0, 6.0, "low"),
    RunSpec((Hump(0.5, 0.05, 5.0),), 2.5, 6.0, "high"),
    RunSpec((Hump(0.5, 0.05, 6.0),), 4.0, 5.0, "fast"),
    RunSpec((RandomRoad("C", 5),), 10.0, 8.0, "rough"),
)
HUMPS = RUNS[:3]
"""Without the rough road: what needs no more than humps takes half as long without it."""
CUBIC = Effect("cubic_stiffness", "rear", {"k3": 1e8})
"""A spring that most tests hide."""


def edited(trials, change, only=None):
    """Return trials with changed values `shape (n_samples, 4)`, in all runs or in one."""
    return [
        replace(trial, recording=replace(trial.recording, values=change(trial.recording.values.copy())))
        if only in (None, trial.name)
        else trial
        for trial in trials
    ]


def once(make):
    """Return a function that makes each thing once, told apart by how its arguments are written."""
    made = {}

    def get(*arguments, **options):
        key = repr((arguments, sorted(options.items())))
        if key not in made:
            made[key] = make(*arguments, **options)
        return made[key]

    return get


@pytest.fixture(scope="session")
def record(tmp_path_factory):
    """Return a function that hides effects in a sedan and returns the run files; nobody writes into their folder."""

    def write(*effects, seed=3, runs=RUNS, parameters=None):
        folder = tmp_path_factory.mktemp("seen")
        write_case(Case("sedan2", parameters, effects, runs, seed=seed), folder, tmp_path_factory.mktemp("truth"))
        return sorted(folder.glob("*.yaml"))

    return once(write)


@pytest.fixture(scope="session")
def trials_of(record):
    """Return a function that gives the trials of the runs of `record`; their recordings cannot be written to."""

    def load(*effects, **options):
        trials = load_trials(record(*effects, **options))
        for trial in trials:
            trial.recording.time.flags.writeable = trial.recording.values.flags.writeable = False
        return tuple(trials)

    return once(load)


@pytest.fixture(scope="session")
def detection_of(trials_of):
    """Return a function that gives the detection of the trials of `trials_of`."""
    return once(lambda *effects, **options: detect(trials_of(*effects, **options)))


@pytest.fixture(scope="session")
def told(record, tmp_path_factory):
    """What the command `diagnose` prints with --json of a hidden spring, tried with two effects, and the folder it writes."""
    folder = tmp_path_factory.mktemp("told")
    paths = [str(path) for path in record(CUBIC, runs=HUMPS)]
    with contextlib.redirect_stdout(io.StringIO()) as printed:
        assert (
            main(["diagnose", "sedan2.yaml", *paths, "--effects", "cubic_stiffness,quadratic_damping", "--out", str(folder), "--json"]) == 0
        )
    return json.loads(printed.getvalue()), folder
