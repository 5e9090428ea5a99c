"""How processes for pieces of work begin: with what was imported before, and in the surroundings of the one that asks."""

import multiprocessing
import os
import subprocess
import sys

import pytest

from vehgen import process_start

SCRIPT = """
import os
import sys

from vehgen.fit.processes import ProcessRunner

WATCHED = ("scipy.signal", "vehgen.effects", "vehgen.report.redraw", "matplotlib")


def seen(name):
    return [module for module in WATCHED if module in sys.modules], os.environ.get(name), os.getcwd(), os.getppid()


if __name__ == "__main__":
    import scipy.signal
    import matplotlib
    import vehgen.effects
    import vehgen.report.redraw

    parents = set()
    with ProcessRunner(1) as runner:
        for value in ("first", "second", None):
            os.environ.pop("FOR_WORK", None)
            if value is not None:
                os.environ["FOR_WORK"] = value
            os.makedirs(f"at_{value}", exist_ok=True)
            os.chdir(f"at_{value}")
            while runner._idle:
                runner._idle.pop().stop()
            ((_, (modules, found, place, parent)),) = runner.as_completed(seen, ["FOR_WORK"])
            parents.add(parent)
            assert found == value, found
            assert place == os.getcwd(), place
    print(*modules, len(parents), parents == {os.getpid()})
"""


@pytest.mark.skipif(not process_start.FORKED, reason="this system's processes start afresh")
def test_a_process_begins_with_what_work_needs_of_what_was_imported_and_in_the_surroundings_of_the_one_that_asks(tmp_path):
    script = tmp_path / "script.py"
    script.write_text(SCRIPT)
    found = subprocess.run([sys.executable, "-W", "error", script], cwd=tmp_path, capture_output=True, text=True, timeout=120, check=False)
    assert found.stderr == ""
    assert found.stdout.split() == ["scipy.signal", "vehgen.effects", "1", "False"]  # one server for all


@pytest.mark.skipif(not process_start.FORKED, reason="this system's processes start afresh")
def test_where_the_server_cannot_be_reached_each_process_starts_afresh(tmp_path):
    script, far = tmp_path / "script.py", tmp_path / ("far" * 40)
    far.mkdir()
    script.write_text(SCRIPT)
    environment = {**os.environ, "TMPDIR": str(far)}  # a socket's name has 107 characters at most
    found = subprocess.run(
        [sys.executable, script], cwd=tmp_path, env=environment, capture_output=True, text=True, timeout=120, check=False
    )
    assert found.stderr == ""
    assert found.stdout.split() == ["1", "True"]


def test_where_a_fork_is_not_safe_each_process_starts_afresh(monkeypatch):
    monkeypatch.setattr(process_start, "FORKED", False)
    assert process_start.process_context().get_start_method() == "spawn"
    assert multiprocessing.get_start_method(allow_none=True) != "forkserver"  # the program's own choice stays


def test_modules_that_no_work_needs_are_not_imported_before_it():
    names = ["vehgen.fit.misfit", "vehgen.commands.diagnose", "vehgen.report.pages", "vehgen.__main__", "scipy.signal", "scipy.stats._qmc",
             "scipy.signal.windows", "rich.console", "matplotlib"]  # fmt: skip
    assert [name for name in names if process_start._is_for_work(name)] == ["vehgen.fit.misfit", "scipy.signal"]
