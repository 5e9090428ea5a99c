"""How commands end: one line and exit code 2 for whatever is raised, quietly on a closed pipe, tidily when stopped."""

from __future__ import annotations

import errno
import os
import subprocess
import sys
import warnings
from collections.abc import Callable
from pathlib import Path
from types import SimpleNamespace

import pytest

from tests.commands.calls import python
from vehgen.commands import diagnose, main
from vehgen.commands.progress import Bars
from vehgen.commands.terminal import MAX_LINE, one_line, print_table, warn
from vehgen.errors import CacheWarning, InputError, printable

RUN = """vehicle: quarter_car
speed: 2 m/s
duration: 1 s
road: [{iso8608: {class: A, seed: 1}}]
outputs:
  load: {axle: axle1, quantity: tyre_load}
"""


def raising(error: BaseException) -> Callable[..., None]:
    def run(options: object) -> None:
        raise error

    return run


def nested(depth: int) -> int:
    return nested(depth + 1)


@pytest.mark.parametrize(
    ("error", "message"),
    [
        (RuntimeError("a defect"), "internal fault: RuntimeError: a defect (please report it; --debug shows where)"),
        (AssertionError(), "internal fault: AssertionError:  (please report it; --debug shows where)"),
        (OSError(errno.ENOSPC, "No space left on device"), "cannot read or write: No space left on device"),
        (PermissionError(errno.EACCES, "Permission denied", "a/b.csv"), "a/b.csv: Permission denied"),
        (BrokenPipeError(errno.EPIPE, "Broken pipe"), "cannot read or write: Broken pipe"),  # a worker's, as stdout is open
        (MemoryError("Unable to allocate 8 TiB"), "there is not enough memory for this (Unable to allocate 8 TiB); a shorter"),
        (MemoryError(), "there is not enough memory for this; a shorter duration, a coarser step or fewer runs need less"),
        (RecursionError("maximum recursion depth exceeded"), "the input is nested too deeply"),
        (InputError("the mass\n  is \x1b[31m\u202e9 kg"), "the mass is \\x1b[31m\\u202e9 kg"),
    ],
    ids=lambda item: type(item).__name__ if isinstance(item, Exception) else "",
)
@pytest.mark.parametrize("debug", [False, True])
def test_whatever_is_raised_is_one_line(
    error: Exception, message: str, debug: bool, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
):
    monkeypatch.setattr("vehgen.commands.models.run", raising(error))
    assert main(["models", *["--debug"] * debug]) == 2
    captured = capsys.readouterr()
    assert captured.out == ""
    lines = captured.err.splitlines()
    assert lines[-1].startswith(f"error: {message}")
    assert (lines[0] == "Traceback (most recent call last):") == debug
    assert len(lines) == 1 or debug


def test_a_deep_recursion_is_one_line(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]):
    monkeypatch.setattr("vehgen.commands.models.run", nested)
    assert main(["--debug", "models"]) == 2
    assert "Traceback" in capsys.readouterr().err
    assert main(["models"]) == 2
    assert capsys.readouterr().err.count("\n") == 1


def test_a_long_message_keeps_its_ends():
    line = one_line("bad.yaml:1:2: unknown key " + "x" * 10_000 + "; did you mean 'mass'?")
    assert len(line) == MAX_LINE
    assert line.startswith("bad.yaml:1:2: unknown key xxx")
    assert line.endswith("xxx; did you mean 'mass'?")
    assert one_line("a\r\n\tb\u2028c") == "a b\\u2028c"


def test_letters_of_all_scripts_stay_and_what_steers_a_terminal_does_not():
    assert printable("Größe 自動車 é 12\u00a0kg\n") == "Größe 自動車 é 12\u00a0kg\n"
    assert printable("\x1b]0;title\x07 \x9b2J \u202egnp.exe \u2066 \ufeff \x7f \udc80").isascii()


def test_warnings_of_a_strangers_text_are_one_line(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]):
    def run(options: object) -> None:
        warnings.warn(CacheWarning("slow:\n \x1b[2J" + "y" * 2000), stacklevel=2)

    monkeypatch.setattr("vehgen.commands.models.run", run)
    assert main(["models"]) == 0
    captured = capsys.readouterr()
    assert captured.err.startswith("warning: slow: \\x1b[2Jyyy")
    assert len(captured.err) == MAX_LINE + 1


MARKUP = "F[/x] [bold]y :car: \x1b[2J"
SHOWN = "F[/x] [bold]y :car: \\x1b[2J"


def test_markup_in_names_is_text(capsys: pytest.CaptureFixture[str]):
    verdict = SimpleNamespace(
        verdict="no_difference",
        reason=f"{MARKUP} fits",
        effects=[],
        faults=[],
        gap=SimpleNamespace(runs=[SimpleNamespace(run=MARKUP, validation=False, before=1.0, after=1.0)]),
        notes=[MARKUP],
        next_experiment=MARKUP,
    )
    diagnose._show(SimpleNamespace(verdict=verdict))
    text = capsys.readouterr().out
    assert f"{SHOWN} fits." in text
    assert f"note: {SHOWN}" in text
    assert f"measure next: {SHOWN}" in text
    print_table(MARKUP, (MARKUP,), [(MARKUP,)])
    warn([MARKUP])
    captured = capsys.readouterr()
    assert captured.out.count(SHOWN) == 3
    assert captured.err == f"warning: {SHOWN}\n"


def test_markup_in_progress_is_text(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]):
    monkeypatch.setenv("FORCE_COLOR", "1")  # a terminal
    monkeypatch.setenv("COLUMNS", "200")
    with Bars(quiet=False) as bars:
        bars.tell(MARKUP, 1, 2, MARKUP)
        bars.say(MARKUP)
    assert capsys.readouterr().err.count(SHOWN) >= 3


def buffered(*arguments: str, **options: object) -> subprocess.Popen[str]:
    """Start vehgen as a shell does: its output is buffered, so that much is written only when it ends."""
    environment = {key: value for key, value in os.environ.items() if key != "PYTHONUNBUFFERED"}
    return subprocess.Popen([sys.executable, "-m", "vehgen", *arguments], env=environment, stderr=subprocess.PIPE, text=True, **options)


PRINTING = [["modes", "quarter_car"], ["schema"], ["models", "--json"], ["--help"], ["--version"]]


@pytest.mark.parametrize("arguments", PRINTING, ids=" ".join)
def test_a_closed_pipe_ends_quietly(arguments: list[str]):
    reading, writing = os.pipe()
    os.close(reading)
    process = buffered(*arguments, stdout=writing)
    os.close(writing)
    assert (process.communicate()[1], process.returncode) == ("", 0)


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="needs /dev/full")
@pytest.mark.parametrize("arguments", PRINTING, ids=" ".join)
def test_a_full_disk_behind_stdout_is_one_line(arguments: list[str]):
    with open("/dev/full", "w") as full:
        process = buffered(*arguments, stdout=full)
        assert (process.communicate()[1], process.returncode) == ("error: cannot read or write: No space left on device\n", 2)


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="needs /dev/full")
def test_a_full_stderr_leaves_the_exit_code():
    with open("/dev/full", "w") as full:
        found = subprocess.run([sys.executable, "-m", "vehgen", "modes", "nowhere"], stderr=full, stdout=subprocess.PIPE, check=False)
    assert (found.returncode, found.stdout) == (2, b"")


def test_termination_removes_temporary_files(work: Path):
    program = (
        "import os, signal, sys, tempfile\n"
        "from vehgen.commands import main, models\n"
        "def run(options):\n"
        "    with tempfile.TemporaryDirectory(dir='.'):\n"
        "        os.kill(os.getpid(), signal.SIGTERM)\n"
        "        signal.pause()\n"
        "models.run = run\n"
        "sys.exit(main(['models']))\n"
    )
    found = python("-c", program, folder=work)
    assert (found.returncode, found.stdout, found.stderr) == (143, "", "")
    assert list(work.iterdir()) == []


@pytest.mark.slow
def test_commands_work_without_docstrings_and_assertions(work: Path):
    (work / "run.yaml").write_text(RUN)
    for arguments in (["modes", "quarter_car"], ["--help"], ["simulate", "run.yaml"], ["build", "quarter_car", "--no-plots"]):
        plain, stripped = (python(*options, "-m", "vehgen", *arguments, folder=work) for options in ([], ["-OO"]))
        assert (stripped.returncode, stripped.stderr) == (0, "")
        if arguments[0] != "build":  # which prints how long it took
            assert stripped.stdout == plain.stdout


@pytest.mark.thorough
def test_a_run_without_numbas_compiler_says_what_it_costs(work: Path):
    (work / "run.yaml").write_text(RUN)
    found = python("-m", "vehgen", "simulate", "run.yaml", folder=work, NUMBA_DISABLE_JIT="1")
    assert found.returncode == 0
    assert found.stderr == (
        "warning: NUMBA_DISABLE_JIT is set: kernels run in plain Python, some hundred times slower; unset it to compile them\n"
    )


@pytest.mark.thorough
def test_a_cache_that_cannot_be_used_costs_time_only(work: Path):
    (work / "run.yaml").write_text(RUN)
    (work / "taken").write_text("mine")
    found = python("-m", "vehgen", "simulate", "run.yaml", folder=work, VEHGEN_CACHE="taken")
    assert found.returncode == 0
    assert found.stderr.startswith("warning: the kernel cache taken is not used: File exists; kernels are compiled anew")
    assert found.stderr.count("\n") == 1
    assert (work / "taken").read_text() == "mine"
    assert (work / "run_response.csv").exists()


@pytest.mark.thorough
@pytest.mark.skipif(not Path("/dev/null").exists(), reason="needs a home in which nothing can be made")
def test_a_home_that_takes_nothing_costs_time_only(work: Path):
    (work / "run.yaml").write_text(RUN)
    nowhere = dict.fromkeys(("VEHGEN_CACHE", "XDG_CACHE_HOME", "XDG_CONFIG_HOME", "MPLCONFIGDIR"), "")
    found = python("-m", "vehgen", "simulate", "run.yaml", "--plot", folder=work, HOME="/dev/null", **nowhere)
    assert found.returncode == 0
    assert found.stderr.startswith("warning: the kernel cache /dev/null/.cache/vehgen is not used: ")
    assert found.stderr.count("\n") == 1
    assert {"run_response.csv", "run_response.png"} < {path.name for path in work.iterdir()}
