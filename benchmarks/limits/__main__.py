"""How far kernels are from the machine's limit: `python -m benchmarks.limits [--against SRC]`.

This checkout's kernels and those of another one (`SRC` is its folder `src`) are timed in turns, each time in a process of its own, and so
are the machine's rates of arithmetic and of reading; the shortest counts. A limit is what a step's instructions, or its constants, would
take at these rates, whichever is more.
"""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
from pathlib import Path

from benchmarks.limits.machine import Rates, Work, rates, work_of

HERE = Path(__file__).parents[2] / "src"
WORKER = Path(__file__).with_name("worker.py")


def timed(source: Path) -> dict[str, float]:
    """Return nanoseconds per step and individual by vehicle, of the kernels of a checkout."""
    environment = {**os.environ, "PYTHONPATH": str(source), "OPENBLAS_NUM_THREADS": "1"}
    done = subprocess.run([sys.executable, str(WORKER)], env=environment, capture_output=True, encoding="utf-8", check=False)
    if done.returncode:
        raise SystemExit(f"kernels of {source} could not be timed: {done.stderr.strip()[-500:]}")
    found: dict[str, float] = json.loads(done.stdout)
    return found


def table(before: dict[str, float] | None, here: dict[str, float], work: dict[str, Work], best: Rates) -> list[str]:
    """Return a table in Markdown, a row a vehicle; a step with force laws is not counted, and has no limit."""
    head = [
        "vehicle",
        "against [ns]",
        "here [ns]",
        "ratio",
        "instructions",
        "constants",
        "arithmetic [ns]",
        "reading [ns]",
        "limit/here",
    ]
    rows = [head, ["---"] * len(head)]
    for name, taken in here.items():
        old = ["", f"{taken:.2f}", ""] if before is None else [f"{before[name]:.2f}", f"{taken:.2f}", f"{taken / before[name]:.2f}"]
        if name in work:
            own = work[name]
            arithmetic, reading = best.arithmetic(own), best.reading(own)
            limits = [
                f"{own.instructions}",
                f"{own.constants}",
                f"{arithmetic:.2f}",
                f"{reading:.2f}",
                f"{max(arithmetic, reading) / taken:.2f}",
            ]
        else:
            limits = [""] * 5
        rows.append([name, *old, *limits])
    return [f"| {' | '.join(row)} |" for row in rows]


def main() -> None:
    """Time and print."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--against", type=Path, metavar="SRC", help="the folder src of another checkout")
    parser.add_argument("--rounds", type=int, default=3, help="turns (default 3)")
    arguments = parser.parse_args()
    sources = [HERE] if arguments.against is None else [arguments.against.resolve(), HERE]
    found: list[list[dict[str, float]]] = [[] for _ in sources]
    best = rates()
    for turn in range(arguments.rounds):
        for number, source in enumerate(sources):
            found[number].append(timed(source))
            print(f"turn {turn + 1}: {source}", file=sys.stderr, flush=True)
        best = best.better(rates())
    shortest = [{name: min(turn[name] for turn in turns) for name in turns[0]} for turns in found]
    here = shortest[-1]
    print(f"Instructions a ns of one core, each for one number: {best.fused:.1f} products fused with sums, {best.mixed:.1f} of these")
    print(f"and sums side by side; {best.read:.1f} numbers read from the first cache.\n")
    print("\n".join(table(shortest[0] if len(shortest) > 1 else None, here, work_of(here), best)))


if __name__ == "__main__":
    main()
