"""Many hostile files of every format, and what vehgen makes of them: `python -m benchmarks.fuzz --files 20000 --seed 1 --processes 2`."""

from __future__ import annotations

import argparse
import tempfile
import threading
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from tests.fuzzing.cases import FORMATS, read_case
from tests.fuzzing.faults import Faults
from tests.fuzzing.fuzzer import make_case
from tests.fuzzing.harness import Worker


def arguments() -> argparse.Namespace:
    """Return the options of the command line."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--files", type=int, default=20000, help="how many")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--first", type=int, default=0, help="the number of the first case")
    parser.add_argument("--processes", type=int, default=1)
    parser.add_argument("--formats", default=",".join(FORMATS), help="some of them only")
    parser.add_argument("--compiling", type=float, default=0.01, help="share that goes through commands that compile kernels, seconds each")
    parser.add_argument("--faults", type=Path, help="a folder for reproducers")
    parser.add_argument("--again", type=Path, help="try one reproducer of such a folder again")
    return parser.parse_args()


def work(
    numbers: list[int], options: argparse.Namespace, folder: Path, faults: Faults, lock: threading.Lock, stop: threading.Event
) -> None:
    """Try cases in a worker process of their own, until told to stop."""
    with Worker(folder) as worker:
        for number in numbers:
            if stop.is_set():
                return
            case = make_case(options.seed, number, options.compiling)
            verdict = worker.try_case(case)
            with lock:
                faults.add(number, case, verdict)


def main() -> None:
    """Try the files; print the outcomes by format, and every distinct fault once."""
    options = arguments()
    start = time.monotonic()
    faults = Faults()
    with tempfile.TemporaryDirectory() as scratch:
        if options.again:
            with Worker(Path(scratch)) as worker:
                verdict = worker.try_case(read_case(options.again))
            print(verdict.outcome, *verdict.reasons, verdict.answer.message, verdict.answer.crash, sep="\n")
            return
        formats = set(options.formats.split(","))
        numbers = [n for n in range(options.first, options.first + options.files) if FORMATS[n % len(FORMATS)] in formats]
        lock, stop = threading.Lock(), threading.Event()
        with ThreadPoolExecutor(options.processes) as pool:
            shares = [[n for n in numbers if n // len(FORMATS) % options.processes == k] for k in range(options.processes)]
            jobs = [pool.submit(work, share, options, Path(scratch) / str(k), faults, lock, stop) for k, share in enumerate(shares)]
            try:
                for job in jobs:
                    job.result()
            except KeyboardInterrupt:
                stop.set()  # each process ends with its file; what was tried is told
    print(faults.table())
    print(f"\n{len(faults.counts)} distinct faults in {sum(faults.outcomes.values())} files, {time.monotonic() - start:.0f} s")
    print(faults.list())
    if options.faults:
        faults.write(options.faults)


if __name__ == "__main__":
    main()
