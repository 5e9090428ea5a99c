"""Pieces of work in processes of their own: their values, and what becomes of those that are killed."""

import multiprocessing
import os
import re
import signal
import threading
import time
from contextlib import closing
from multiprocessing.reduction import ForkingPickler
from pathlib import Path

import pytest

from vehgen import process_start
from vehgen.errors import InputError
from vehgen.fit import processes
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


def slow(number):
    time.sleep(0.05)
    if number < 0:
        raise InputError("below zero")
    return number, os.getpid()


class OddError(Exception):
    """An error whose arguments are not those of its class, as some libraries have."""

    def __init__(self, code, text):
        super().__init__(f"code {code}: {text}")


class Unreadable:
    """A value that can be packed, but not unpacked."""

    def __reduce__(self):
        return int, ("no number",)


def begun_and(work):
    """Leave a trace of being begun, and answer what was asked for."""
    folder, asked = work
    (Path(folder) / f"{asked}{len(list(Path(folder).iterdir()))}").touch()
    if asked == "odd error":
        raise OddError(7, "the library\nfailed")
    return {"lock": threading.Lock(), "unreadable": Unreadable()}.get(asked, asked)


@pytest.mark.parametrize("forked", [True, False])
def test_every_input_has_its_value_from_another_process(monkeypatch, forked):
    monkeypatch.setattr(process_start, "FORKED", forked and process_start.FORKED)
    with ProcessRunner(2) as runner:
        found = dict(runner.as_completed(squared, iter(range(6))))
        assert {item: value for item, (value, _) in found.items()} == {number: number**2 for number in range(6)}
        first = {process for _, process in found.values()}
        assert HERE not in first
        assert len(first) <= 2
        again = {process for _, (_, process) in runner.as_completed(squared, range(2))}
        assert again <= first  # they last
    assert multiprocessing.active_children() == []
    assert [item for item, _ in Runner().as_completed(squared, range(3))] == [0, 1, 2]


def test_short_work_stays_here_and_long_work_is_spread_in_order(monkeypatch):
    with ProcessRunner(2) as runner:
        assert list(runner.map(slow, range(3))) == [(number, HERE) for number in range(3)]
        monkeypatch.setattr(processes, "WORTH_PROCESSES_S", 0.18)
        found = list(runner.map(slow, range(6)))
        assert [number for number, _ in found] == list(range(6))
        assert [process == HERE for _, process in found] == [True, *5 * [False]]  # with the three before it took 0.2 s
        with pytest.raises(InputError, match="below zero"):
            list(runner.map(slow, [1, 2, -1, 3]))
        assert [number for number, _ in runner.map(slow, range(3))] == [0, 1, 2]


def test_work_is_taken_only_when_there_is_room():
    taken = []

    def works():
        for number in range(5):
            taken.append(number)
            yield number

    with ProcessRunner(1) as runner, closing(runner.as_completed(squared, works())) as answers:
        assert next(answers)[0] == 0
        assert taken == [0]


@pytest.mark.thorough
@pytest.mark.skipif(not hasattr(signal, "SIGKILL"), reason="this system has no SIGKILL")
def test_a_killed_process_is_begun_again_and_one_that_always_dies_costs_the_others_nothing(tmp_path):
    once, always, never = (tmp_path / name for name in ("once", "always", "never"))
    for folder in (once, always, never):
        folder.mkdir()
    works = [(str(once), 1), (str(always), 99), (str(never), 0)]
    with ProcessRunner(2) as runner:
        found = {Path(work[0]).name: value for work, value in runner.as_completed(killed_until, works)}
    assert found["once"] == 1
    assert found["never"] == 0
    assert isinstance(found["always"], Lost)
    assert f"{RETRIES + 1} times" in found["always"].reason
    assert len(list(always.iterdir())) == RETRIES + 1


@pytest.mark.skipif(not hasattr(signal, "pause"), reason="this system has no signals to wait for")
def test_processes_end_with_the_iteration():
    with ProcessRunner(2) as runner:
        with closing(runner.as_completed(at_once_or_never, [0, 1])) as answers:
            assert next(answers) == (0, 0)
            assert len(multiprocessing.active_children()) == 2
        assert len(multiprocessing.active_children()) == 1  # the one that is free
    assert multiprocessing.active_children() == []


def test_a_process_that_nobody_waits_for_any_more_ends_without_a_word(capfd):
    with ProcessRunner(1) as runner, closing(runner.as_completed(slow, [1])) as answers:
        next(answers)
        (worker,) = runner._idle
        worker.end.send_bytes(ForkingPickler.dumps(2))
        worker.end.close()
        worker.process.join()
    assert worker.process.exitcode == 0
    assert capfd.readouterr().err == ""


@pytest.mark.parametrize(("asked", "told"), [("lock", "cannot be sent.*TypeError: .*lock"), ("unreadable", "cannot be read.*ValueError")])
def test_a_value_that_cannot_travel_is_lost_at_once_and_costs_the_others_nothing(tmp_path, asked, told):
    with ProcessRunner(1) as runner:
        found = {work[1]: value for work, value in runner.as_completed(begun_and, [(str(tmp_path), asked), (str(tmp_path), "text")])}
        assert isinstance(found[asked], Lost)
        assert re.search(told, found[asked].reason)
        assert found["text"] == "text"
        assert len(list(tmp_path.iterdir())) == 2  # begun once each
        assert len(multiprocessing.active_children()) == 1  # it lives


def test_an_error_that_cannot_be_rebuilt_is_told_by_its_type_and_text(tmp_path):
    with ProcessRunner(1) as runner, pytest.raises(RuntimeError, match=r"^OddError: code 7: the library failed$"):
        list(runner.as_completed(begun_and, [(str(tmp_path), "odd error")]))
