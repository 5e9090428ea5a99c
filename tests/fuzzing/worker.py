"""The process that reads hostile files: it imports vehgen once, and forks for every file, within limits and under an audit hook.

Run by :class:`tests.fuzzing.harness.Worker` as `python -m tests.fuzzing.worker SCRATCH`; jobs come as lines of JSON, answers go back so.
"""

from __future__ import annotations

import gc
import importlib
import io
import json
import math
import os
import resource
import select
import signal
import sys
import time
import traceback
import warnings
from pathlib import Path
from typing import Any

from tests.fuzzing.audit import Audit
from tests.fuzzing.healthy import healthy
from tests.fuzzing.mischief import do
from tests.fuzzing.stages import STAGES, warm_up
from vehgen.commands import main
from vehgen.errors import InputError, ModelWarning

COMMANDS = (("modes", "sedan2"), ("static", "sedan2"), ("effects",), ("simulate", "absent.yaml"))


def address_space() -> int:
    """Return the size of this process's address space [bytes]."""
    return int(Path("/proc/self/statm").read_text().split()[0]) * resource.getpagesize()


def by_api(job: dict[str, Any]) -> dict[str, Any]:
    """Load, derive and generate; return what an answer holds of the refusal."""
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        try:
            {**STAGES, "mischief": do}[job["format"]](job["main"])
            found: dict[str, Any] = {}
        except InputError as error:
            place = error.position
            found = {"message": str(error), "place": place and (str(place.file), place.line, place.column)}
    doubts = [str(item.message) for item in caught if issubclass(item.category, ModelWarning)]
    return {**found, "output": "\n".join(doubts)}


def by_command(job: dict[str, Any]) -> dict[str, Any]:
    """Run a command of the command line with its output caught; return what an answer holds of the refusal."""
    outputs = [io.TextIOWrapper(io.BytesIO(), encoding="utf-8", errors="surrogatepass") for _ in range(2)]
    sys.stdout, sys.stderr = outputs
    try:
        try:
            code = main(job["command"])
        except SystemExit as left:  # --help and --version end so
            code = left.code
        for stream in outputs:
            stream.flush()
    finally:
        sys.stdout, sys.stderr = sys.__stdout__, sys.__stderr__
    printed, told = (stream.buffer.getvalue().decode("utf-8", "surrogatepass") for stream in outputs)
    if code == 0:
        return {"output": printed + told}
    lines = [line for line in told.removesuffix("\n").split("\n") if not line.startswith("warning: ")]
    return {"output": printed, "message": "\n".join(lines), "code": code}


def child(job: dict[str, Any], audit: Audit, pipe: int) -> None:
    """Do one job in a forked process, send the answer, and leave."""
    folder = Path(job["folder"])
    os.chdir(folder / job["start"])
    start = address_space()
    resource.setrlimit(resource.RLIMIT_CPU, (math.ceil(job["seconds"]) + 1, resource.RLIM_INFINITY))
    resource.setrlimit(resource.RLIMIT_AS, (start + int(job["megabytes"] * 2**20), resource.RLIM_INFINITY))
    own = [os.environ["VEHGEN_CACHE"], os.environ["MPLCONFIGDIR"]] if job["command"] else []
    own += [os.environ["TMPDIR"]] if job["kernels"] else []
    audit.arm([str(folder / "out"), *own], job["kernels"])
    answer: dict[str, Any] = {}
    done = False
    began = resident()
    try:
        answer = by_command(job) if job["command"] else by_api(job)
        done = True
    finally:
        audit.armed = False
        resource.setrlimit(resource.RLIMIT_AS, (resource.RLIM_INFINITY, resource.RLIM_INFINITY))
        if not done:
            kind = sys.exc_info()[0]
            answer = {"crash": traceback.format_exc(limit=-30), "crash_type": kind.__name__ if kind else ""}
        answer |= {"seconds": time.process_time(), "megabytes": resident() - began, "effects": sorted(set(audit.found))[:5]}
        answer["kernels"] = [name for name in sys.modules if name.startswith("vehgen_kernel")]
        with os.fdopen(pipe, "w") as stream:
            json.dump(answer, stream)
        os._exit(0)


def resident() -> float:
    """Return the largest resident memory of this process so far [MB]."""
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024


def computes(process: int) -> bool:
    """Whether a process runs or waits for a processor, and for nothing else."""
    return Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()[0] == "R"


def handle(job: dict[str, Any], audit: Audit) -> dict[str, Any]:
    """Fork a child for a job and wait for its answer, for its end, or until it has waited too long."""
    reading, writing = os.pipe()
    process = os.fork()
    if process == 0:
        os.close(reading)
        child(job, audit, writing)
    os.close(writing)
    data = b""
    until = time.monotonic() + job["wait"]
    while True:
        ready, _, _ = select.select([reading], [], [], max(0.0, until - time.monotonic()))
        if not ready and computes(process):  # on a busy machine; its limit of CPU time ends it
            until = time.monotonic() + 1.0
            continue
        block = os.read(reading, 1 << 16) if ready else b""
        if not block:
            break
        data += block
    os.close(reading)
    if waited := not ready:
        os.kill(process, signal.SIGKILL)
    _, status, used = os.wait4(process, 0)
    if data and not waited:
        return dict(json.loads(data))
    seconds = used.ru_utime + used.ru_stime
    if seconds > job["seconds"]:
        return {"seconds": seconds}
    kind = "waits for ever" if waited else f"killed by signal {os.WTERMSIG(status)}" if os.WIFSIGNALED(status) else "left without a word"
    return {"crash": "the process ended without an answer", "crash_type": kind, "seconds": seconds}


def warm(scratch: Path) -> None:
    """Do everything once with healthy files."""
    chosen = []
    for format, cases in healthy().items():
        for number, case in enumerate(cases):
            folder = scratch / "healthy" / f"{format}{number}"
            case.write(folder)
            chosen.append((format, folder, case.main))
    for format, folder, name in chosen:
        os.chdir(folder)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", ModelWarning)
            warm_up([(format, name)])
    os.chdir(scratch)
    importlib.import_module("matplotlib.font_manager")  # asks the system for its fonts, once
    (scratch / "healthy" / "no.mat").write_bytes(b"MATLAB 5.0 MAT-file".ljust(124) + b"\x00\x01IM" + bytes(200))
    by_api({"format": "export", "main": str(scratch / "healthy" / "no.mat")})  # importing its reader asks for the machine's name
    for command in COMMANDS:
        by_command({"command": list(command)})


def serve() -> None:
    """Answer jobs until standard input ends."""
    replies = os.fdopen(os.dup(1), "w")
    os.dup2(2, 1)
    audit = Audit()
    warm(Path(sys.argv[1]))
    gc.collect()
    gc.freeze()
    replies.write("ready\n")
    replies.flush()
    for line in sys.stdin:
        replies.write(json.dumps(handle(json.loads(line), audit)) + "\n")
        replies.flush()


if __name__ == "__main__":
    serve()
