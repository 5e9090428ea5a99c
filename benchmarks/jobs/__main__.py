"""Time whole jobs: `python -m benchmarks.jobs [--against SRC] [NAMES]`.

Each job is a command in a process of its own, with one thread, over recordings that are made anew from a seed. With `--against`, the folder
`src` of another checkout, both take turns; the round of least CPU time counts. The first round fills each checkout's own cache of
kernels, which may be kept for further calls.
"""

from __future__ import annotations

import argparse
import json
import os
import shlex
import shutil
import subprocess
import sys
import tempfile
from functools import partial
from pathlib import Path

from benchmarks.jobs.inputs import LONG, MANY_CROSSINGS, ROOT, import_phones, write_recordings
from benchmarks.jobs.tables import Taken, shortest, split, totals

HERE = ROOT / "src"
SAMPLER = Path(__file__).with_name("sampler.py")
ONE_THREAD = {f"{name}_NUM_THREADS": "1" for name in ("OPENBLAS", "OMP", "MKL", "NUMBA")}
INPUTS = {
    "phones": import_phones,
    "sedan": partial(write_recordings, vehicle="sedan2", friction=False),
    "sedan_friction": partial(write_recordings, vehicle="sedan2", friction=True),
    "truck": partial(write_recordings, vehicle="tractor5", friction=False),
    "truck_friction": partial(write_recordings, vehicle="tractor5", friction=True),
    "truck_many": partial(write_recordings, vehicle="tractor5", friction=True, crossings=MANY_CROSSINGS, duration=LONG),
}
"""What writes a folder of runs."""
JOBS = {
    "dhcm": ("phones", "calibrate tractor5 hump_2ms.yaml hump_3ms.yaml --method dhcm"),
    "joint": ("phones", "calibrate tractor5 hump_2ms.yaml hump_3ms.yaml --method joint"),
    "shcm": ("sedan", "calibrate sedan2 low_2.yaml high_3.yaml --method shcm --sensors F"),
    "healthy": ("sedan", "diagnose sedan2 low_2.yaml high_3.yaml high_4.yaml"),
    "friction": ("sedan_friction", "diagnose sedan2 low_2.yaml high_3.yaml high_4.yaml"),
    "truck_healthy": ("truck", "diagnose tractor5 low_2.yaml high_3.yaml high_4.yaml"),
    "truck": ("truck_friction", "diagnose tractor5 low_2.yaml high_3.yaml high_4.yaml"),
    "truck_8": ("truck_many", f"diagnose tractor5 {' '.join(f'{name}.yaml' for name in MANY_CROSSINGS)}"),
}
"""Folder and command of each job."""


def take(name: str, source: Path, folder: Path, cache: Path) -> Taken:
    """Run a job by the code in a folder `src`; `folder` holds its runs."""
    out, told = folder / "out", folder / "sampled.json"
    environment = {**os.environ, **ONE_THREAD, "PYTHONPATH": str(source), "VEHGEN_CACHE": str(cache)}
    arguments = [sys.executable, str(SAMPLER), str(told), *shlex.split(JOBS[name][1]), "--out", str(out), "--json"]
    done = subprocess.run(arguments, cwd=folder, env=environment, capture_output=True, encoding="utf-8", check=False)
    if done.returncode:
        raise SystemExit(f"{name} by {source} ended with {done.returncode}: {done.stderr.strip()[-500:]}")
    return Taken(**json.loads(told.read_text(encoding="utf-8")))


def measure(names: list[str], sources: list[Path], rounds: int, caches: Path | None = None) -> dict[str, list[Taken]]:
    """Return what each job took by each checkout, in turns; their kernels are kept in a folder `caches` of their own."""
    found: dict[str, list[Taken]] = {}
    with tempfile.TemporaryDirectory() as temporary:
        home = Path(temporary)
        for kind in dict.fromkeys(JOBS[name][0] for name in names):
            INPUTS[kind](home / kind)
        for name in names:
            taken: list[list[Taken]] = [[] for _ in sources]
            for round_ in range(rounds):
                for number, source in enumerate(sources):
                    place = home / f"{name}_{number}_{round_}"
                    shutil.copytree(home / JOBS[name][0], place)
                    taken[number].append(take(name, source, place, (caches or home) / ("here" if source == HERE else "against")))
                    print(f"{name}, {source}: {taken[number][-1].cpu:.1f} s", file=sys.stderr, flush=True)
            found[name] = [shortest(items) for items in taken]
    return found


def main() -> None:
    """Run the jobs and print the tables."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("names", nargs="*", metavar="NAME", help=f"jobs, of {', '.join(JOBS)} (default: all)")
    parser.add_argument("--against", type=Path, metavar="SRC", help="the folder src of another checkout")
    parser.add_argument("--rounds", type=int, default=2, help="how often each runs (default 2)")
    parser.add_argument("--caches", type=Path, metavar="DIR", help="where kernels are kept for further calls (default: nowhere)")
    options = parser.parse_args()
    names = options.names or list(JOBS)
    if unknown := [name for name in names if name not in JOBS]:
        parser.error(f"no job {unknown[0]}; there are {', '.join(JOBS)}")
    against = [options.against.resolve()] if options.against else []
    found = measure(names, [*against, HERE], options.rounds, options.caches and options.caches.resolve())
    for lines in (totals(found), split(found, "stages"), split(found, "rooms")):
        print("\n".join(lines), end="\n\n")


if __name__ == "__main__":
    main()
