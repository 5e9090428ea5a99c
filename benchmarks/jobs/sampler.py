"""Run a `vehgen` command and write where its CPU time went: `python sampler.py OUT.json calibrate ...`.

A timer interrupts every few milliseconds of CPU time; all CPU time since the last interruption counts for the function that is under way
(a compiled one delays the interruption, so that time is counted, not interruptions). It imports nothing of `vehgen`, so that any version of
it can be run. One process and one thread: whoever asks for the number of cores is told 1.
"""

from __future__ import annotations

import json
import os
import runpy
import signal
import sys
import time
from collections import Counter
from collections.abc import Iterable
from pathlib import Path
from types import FrameType

EVERY_S = 0.004
STAGES = {"calibrate/genetic": "search", "calibrate/polish": "polish", "calibrate/intervals": "intervals", "report": "figures"}
"""What a calibration does, by the file or folder that does it."""
FORMER = {"identify": "calibrate"}
"""Rooms that had another name in older code."""
KERNELS = ("codegen/kernel", "codegen/population_run")
COMPILERS = ("numba", "llvmlite")


def place(files: Iterable[str]) -> tuple[str, str]:
    """Return the stage and the room of a stack, the innermost of its files first.

    The room is the package of `vehgen` whose function is under way, `codegen: kernels` where a kernel runs; `compiling` and `imports`
    stand by themselves.
    """
    below: list[str] = []
    room = ""
    for file in (name.replace("\\", "/") for name in files):
        if "/vehgen/" in file:
            own = file.rpartition("/vehgen/")[2].removesuffix(".py")
            first, _, rest = own.partition("/")
            below.append("/".join(filter(None, (FORMER.get(first, first), rest))))
            room = room or below[-1].partition("/")[0]
            room = "codegen: kernels" if room == "codegen" and below[0] in KERNELS else room
        elif "importlib._bootstrap" in file:
            room = room or "imports"
        elif not room and any(f"/{name}/" in file for name in COMPILERS):
            room = "compiling"
    stages = (stage for path in below for start, stage in STAGES.items() if path.startswith(start))
    return next(stages, room if room in ("imports", "compiling") else "the rest"), room or "the rest"


class Sampler:
    """Counts CPU seconds by the stack that is under way."""

    def __init__(self) -> None:
        self.seconds: Counter[tuple[str, ...]] = Counter()
        self._last = 0.0

    def __call__(self, _number: int, frame: FrameType | None) -> None:
        """Count the time since the last call."""
        files = []
        while frame is not None:
            files.append(frame.f_code.co_filename)
            frame = frame.f_back
        now = time.process_time()
        self.seconds[tuple(files)] += now - self._last
        self._last = now

    def totals(self) -> dict[str, dict[str, float]]:
        """Return CPU seconds by stage and by room."""
        found: dict[str, Counter[str]] = {"stages": Counter(), "rooms": Counter()}
        for files, seconds in self.seconds.items():
            stage, room = place(files)
            found["stages"][stage] += seconds
            found["rooms"][room] += seconds
        return {key: dict(value.most_common()) for key, value in found.items()}


def main() -> None:
    """Run the command, then write its totals; exits as the command does."""
    out, sys.argv = Path(sys.argv[1]), ["vehgen", *sys.argv[2:]]
    os.cpu_count = lambda: 1
    sampler = Sampler()
    signal.signal(signal.SIGPROF, sampler)
    signal.setitimer(signal.ITIMER_PROF, EVERY_S, EVERY_S)
    try:
        runpy.run_module("vehgen", run_name="__main__", alter_sys=True)
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0)
        out.write_text(json.dumps({"cpu": time.process_time(), **sampler.totals()}), encoding="utf-8")


if __name__ == "__main__":
    main()
