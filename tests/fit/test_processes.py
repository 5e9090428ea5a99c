"""Pieces of work in processes of their own: their values, and what becomes of those that are killed."""

import multiprocessing
import os
import signal
from contextlib import closing
from pathlib import Path

import pytest

from vehgen.fit.parallel import RETRIES, Lost, Runner
from vehgen.fit.processes import ProcessRunner

HERE = os.getpid()


def squared(number):
    return number**2, os.getpid()


def killed_until(work):
    """Die by SIGKILL, as under the kernel's out-of-memory killer, until so many traces were left."""
    folder, times = work
    traces = len(list(Path(folder).iterdir()))
    if traces < times:
        (Path(folder) / str(traces)).touch()
        os.kill(os.getpid(), signal.SIGKILL)
    return traces


def at_once_or_never(number):
    if number:
        signal.pause()
    return number


def test_every_input_has_its_value_from_a_process_of_its_own():
    found = dict(ProcessRunner(processes=2).as_completed(squared, iter(range(4))))
    assert {item: value for item, (value, _) in found.items()} == {0: 0, 1: 1, 2: 4, 3: 9}
    assert len({process for _, process in found.values()} | {HERE}) == 5
    assert [item for item, _ in Runner().as_completed(squared, range(3))] == [0, 1, 2]


def test_work_is_taken_only_when_there_is_room():
    taken = []

    def works():
        for number in range(5):
            taken.append(number)
            yield number

    with closing(ProcessRunner(processes=1).as_completed(squared, works())) as answers:
        assert next(answers)[0] == 0
        assert taken == [0]


@pytest.mark.skipif(not hasattr(signal, "SIGKILL"), reason="this system has no SIGKILL")
def test_a_killed_process_is_begun_again_and_one_that_always_dies_costs_the_others_nothing(tmp_path):
    once, always, never = (tmp_path / name for name in ("once", "always", "never"))
    for folder in (once, always, never):
        folder.mkdir()
    works = [(str(once), 1), (str(always), 99), (str(never), 0)]
    found = {Path(work[0]).name: value for work, value in ProcessRunner(processes=2).as_completed(killed_until, works)}
    assert found["once"] == 1
    assert found["never"] == 0
    assert isinstance(found["always"], Lost)
    assert f"{RETRIES + 1} times" in found["always"].reason
    assert len(list(always.iterdir())) == RETRIES + 1


@pytest.mark.skipif(not hasattr(signal, "pause"), reason="this system has no signals to wait for")
def test_processes_end_with_the_iteration():
    with closing(ProcessRunner(processes=2).as_completed(at_once_or_never, [0, 1])) as answers:
        assert next(answers) == (0, 0)
        assert len(multiprocessing.active_children()) == 1
    assert multiprocessing.active_children() == []
