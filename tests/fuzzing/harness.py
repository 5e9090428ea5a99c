"""Gives cases to a worker process and judges its answers."""

from __future__ import annotations

import json
import os
import re
import shutil
import subprocess
import sys
import time
from dataclasses import replace
from pathlib import Path
from types import TracebackType
from typing import Any

from tests.fuzzing.cases import Case
from tests.fuzzing.healthy import ROOT
from tests.fuzzing.judge import FAULT, TOO_SLOW, Answer, Limits, Verdict, judge

COMPILING = {"simulate", "assess", "build", "import", "calibrate", "diagnose", "validate", "sensors", "sensitivity", "bench"}
"""Commands that compile kernels."""

KERNEL_LIMITS = Limits(60.0, 3000.0)
"""What a command may cost that compiles a kernel: its compiler takes seconds by itself."""

YARDSTICK_S = 0.022
"""What :func:`yardstick` takes where the limits of time hold as they are [CPU s], with the other cores at rest."""
TRIES = 3
"""So often is a case tried that seems too slow."""
MOST_SLOWNESS = 6.0
"""No machine counts as slower than by this factor."""


def yardstick() -> float:
    """Return the CPU time that a piece of plain Python takes just now [s]: twice as much where another core is busy, too."""
    begun = time.process_time()
    sum(len(str(number)) for number in range(300_000))
    return time.process_time() - begun


def slowness() -> float:
    """Return by what factor this machine is slower just now than the one for which the limits of time were set, 1 at least."""
    return min(max(sorted(yardstick() for _ in range(5))[2] / YARDSTICK_S, 1.0), MOST_SLOWNESS)


class Worker:
    """A worker process and its scratch folder; a context manager.

    Parameters
    ----------
    scratch
        An empty folder, deleted by nobody: cases are written below it, the kernel cache and a home of its own stand there.
    """

    def __init__(self, scratch: Path) -> None:
        self.scratch = scratch.resolve()
        self._number = 0

    def __enter__(self) -> Worker:
        for name in ("home", "cache", "cases", "healthy", "temporary"):
            (self.scratch / name).mkdir(parents=True, exist_ok=True)
        for name in ("cache", "temporary"):
            (self.scratch / name).chmod(0o700)
        threads = dict.fromkeys(("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS", "NUMBA_NUM_THREADS"), "1")
        import vehgen

        path = os.pathsep.join([str(Path(vehgen.__file__).parents[1]), str(ROOT), os.environ.get("PYTHONPATH", "")])
        home = {"HOME": str(self.scratch / "home"), "MPLCONFIGDIR": str(self.scratch / "home"), "VEHGEN_CACHE": str(self.scratch / "cache")}
        home["TMPDIR"] = str(self.scratch / "temporary")
        self._log = (self.scratch / "worker.log").open("w")
        self._process = subprocess.Popen(
            [sys.executable, "-m", "tests.fuzzing.worker", str(self.scratch)],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=self._log,
            text=True,
            cwd=ROOT,
            env={**os.environ, **threads, **home, "MPLBACKEND": "Agg", "PYTHONPATH": path, "PYTHONDONTWRITEBYTECODE": "1"},
        )
        if self._read() != "ready\n":
            self._process.wait()
            self._log.close()
            raise RuntimeError("the worker does not start:\n" + (self.scratch / "worker.log").read_text()[-3000:])
        return self

    def __exit__(self, kind: type[BaseException] | None, value: BaseException | None, trace: TracebackType | None) -> None:
        assert self._process.stdin is not None
        assert self._process.stdout is not None
        self._process.stdin.close()
        self._process.wait(timeout=60)
        self._process.stdout.close()
        self._log.close()

    def _read(self) -> str:
        assert self._process.stdout is not None
        return self._process.stdout.readline()

    def ask(self, job: dict[str, Any]) -> dict[str, Any]:
        """Send a job; return the answer as it came."""
        assert self._process.stdin is not None
        self._process.stdin.write(json.dumps(job) + "\n")
        self._process.stdin.flush()
        return dict(json.loads(self._read()))

    def try_case(self, case: Case, limits: Limits | None = None, patience: float = 10.0) -> Verdict:
        """Write a case's files, have them read, and judge the answer.

        `limits` stand in place of the usual ones; `patience` [s] is how long a file that is waited for may take beyond its CPU time.
        What other processes slow down is tried again: a case is too slow that never is quick.
        """
        for _ in range(TRIES):
            verdict = self._try(case, limits, patience)
            if not any(reason.startswith(TOO_SLOW) for reason in verdict.reasons):
                break
        return verdict

    def _try(self, case: Case, limits: Limits | None, patience: float) -> Verdict:
        self._number += 1
        folder = self.scratch / "cases" / f"{self._number:06d}"
        case.write(folder)
        kernels = bool(case.command) and case.command[0] in COMPILING
        limits = limits or (KERNEL_LIMITS if kernels else Limits())
        job = {"folder": str(folder), "format": case.format, "main": case.main, "command": list(case.command), "kernels": kernels}
        job["start"] = case.start
        job["wait"] = patience + 3 * limits.seconds
        found = self.ask({**job, "seconds": MOST_SLOWNESS * limits.seconds, "megabytes": limits.megabytes})
        if found.get("seconds", 0.0) > limits.seconds:
            found["seconds"] /= slowness()
        new = new_files(case, folder)
        if not kernels and found.get("kernels"):
            new.append("a kernel was imported")
        answer = read_answer(found, new)
        verdict = judge(answer, folder, limits, needs_place=case.needs_place)
        verdict = replace(checked_for_name(case, verdict), compiles=kernels)
        shutil.rmtree(folder)
        return verdict


def checked_for_name(case: Case, verdict: Verdict) -> Verdict:
    """A refusal that has no line must at least name a file of the case."""
    if verdict.answer.message is None or case.needs_place or case.format == "options":
        return verdict
    if any(Path(name).name in verdict.answer.message for name in (case.main, *case.files, *case.special)):
        return verdict
    return Verdict(FAULT, (*verdict.reasons, f"no file is named: {verdict.answer.message[:150]}"), verdict.answer)


def new_files(case: Case, folder: Path) -> list[str]:
    """Return, as faults, the files of a folder that the case did not bring, outside its folder `out`."""
    files = {Path(name).as_posix(): data for name, data in case.written.items()}  # a name may hold `//`
    brought = {*files, *case.special}
    present = {path.relative_to(folder).as_posix() for path in folder.rglob("*") if path.is_symlink() or not path.is_dir()}
    stray = sorted(name for name in present - brought if not name.startswith("out/"))
    changed = [name for name, data in files.items() if name in present - set(case.special) and (folder / name).read_bytes() != data]
    gone = sorted(brought - present - {name for name, kind in case.special.items() if kind == "folder"})
    words = {"written": stray, "changed": changed, "removed": gone}
    return [f"a file was {word}: {name[:80]}" for word, names in words.items() for name in names]


def read_answer(found: dict[str, Any], faults: list[str]) -> Answer:
    """Make an answer of what the worker sent; a command's refusal is taken apart."""
    message, place = found.get("message"), found.get("place")
    crash, crash_type = found.get("crash", ""), found.get("crash_type", "")
    if (code := found.get("code")) is not None:
        if code != 2 or not message.startswith("error: ") or message.startswith("error: internal fault"):
            crash, crash_type = message, f"exit code {code} without a clear error"
        message = message.removeprefix("error: ")
        parts = re.match(r"(?P<file>[^:\n]+):(?P<line>\d+):(?P<column>\d+): ", message)
        place = (parts["file"], int(parts["line"]), int(parts["column"])) if parts else None
    effects = (*found.get("effects", ()), *faults)
    costs = {key: float(found.get(key, 0.0)) for key in ("seconds", "megabytes")}
    return Answer(message, tuple(place) if place else None, found.get("output", ""), crash, crash_type, effects, **costs)
