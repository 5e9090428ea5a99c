"""Write run files, recordings and forces of the EMPS benchmark: `python prepare.py DATA_EMPS.mat runs`, one run a period of the motion.

The benchmark (an electro-mechanical positioning system: a carriage, its motor, an encoder) is offered at https://www.nonlinearbenchmark.org.
"""

from __future__ import annotations

import shutil
import sys
from pathlib import Path

import numpy as np
import scipy.io
from numpy.typing import NDArray

from vehgen.files import write_text

Array = NDArray[np.float64]
PERIOD, PERIODS, EVERY = 6237, 4, 10
"""Samples of a period of the motion, how many of them are whole, and every how many samples the encoder is compared."""
HERE = Path(__file__).parent
RUN = """vehicle: emps.yaml
title: "{title}"
step: 1 ms
sample: 10 ms
acquisition: none
forces:
  motor: {{body: carriage, file: {name}_force.csv, time: t, force: F, unit: N}}
sensors:
  encoder: {{body: carriage, channels: {{displacement: {{column: q}}}}}}
recording: {name}.csv
"""


def read_emps(path: Path) -> tuple[Array, Array, Array]:
    """Return times [s], where the carriage is [m], and what the motor pushes with [N], `shape (24841,)` each."""
    data = scipy.io.loadmat(path)
    force = float(data["gtau"].item()) * data["vir"].ravel()
    return 1e-3 * np.arange(len(force)), np.asarray(data["qm"].ravel()), np.asarray(force)


def write_runs(path: Path, folder: Path) -> list[Path]:
    """Write a run file for each period, with its recording and force, and return the run files."""
    time, place, force = read_emps(path)
    folder.mkdir(parents=True, exist_ok=True)
    shutil.copy(HERE / "emps.yaml", folder)
    written = []
    for number in range(PERIODS):
        name, first = f"period_{number + 1}", number * PERIOD
        last = min(first + PERIOD, len(time) - 1)
        last -= (last - first) % EVERY
        part = slice(first, last + 1)
        own = time[: last - first + 1]
        _write_columns(folder / f"{name}_force.csv", "t,F", np.column_stack([own, force[part]]))
        _write_columns(folder / f"{name}.csv", "t,q", np.column_stack([own, place[part] - place[first]])[::EVERY])
        written.append(folder / f"{name}.yaml")
        write_text(written[-1], RUN.format(name=name, title=f"EMPS, period {number + 1} of {path.stem}"))
    return written


def _write_columns(path: Path, header: str, columns: Array) -> None:
    write_text(path, header + "\n" + "".join(f"{t:.10g},{value:.8g}\n" for t, value in columns.tolist()))


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit("usage: python prepare.py DATA_EMPS.mat FOLDER")
    for item in write_runs(Path(sys.argv[1]), Path(sys.argv[2])):
        print(f"wrote {item}")
