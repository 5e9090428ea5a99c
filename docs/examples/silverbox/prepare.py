"""Write run files and recordings from the Silverbox benchmark's file SNLS80mV.csv.

Run it with the path of that file and a folder: `python prepare.py SNLS80mV.csv silverbox_runs`. The benchmark is described in
doi:10.23919/ECC.2013.6669201 and offered at https://www.nonlinearbenchmark.org.
"""

from __future__ import annotations

import shutil
import sys
from collections.abc import Mapping
from pathlib import Path

import numpy as np
import scipy.optimize
import scipy.signal
from numpy.typing import NDArray

from vehgen.files import write_text

Array = NDArray[np.float64]
STEP = 2**14 / 1e7
"""Spacing of the samples [s]."""
FINER = 8
"""Steps of the integration between two samples."""
FORCE, DISPLACEMENT = 1e3, 0.01
"""What 1 V of V1 and of V2 is called here [N, m]."""
BAND = (2, 150)
"""What is compared [Hz]: the resonance and its surroundings, below what the recorder's anti-aliasing filters turn in phase."""
NOISE_BAND = (2, 220)
"""Where the noise is taken [Hz]: up to where the force ends and the sensor's own noise remains."""
TRAINING = slice(40650, 105712)
"""The first three quarters of the multisine part, ten random odd multisines one after the other."""
RUNS = {f"multisine_{i + 1}": (40650 + 8692 * i, 40650 + 8692 * i + 8192) for i in range(7)}
"""The seven whole multisines of the training part, less the last 500 samples of each: first sample, last + 1."""
QUIET_RUNS = {f"low_{i + 1}": (200 + 950 * i, 200 + 950 * (i + 1)) for i in range(4)}
"""The beginning of the arrow-shaped part, where the spring hardly leaves its straight line."""
TESTS = {"multisine": (105712, 127400), "arrow_without_extrapolation": (100, 32100), "arrow_full": (100, 40575)}
"""The three test splits of the benchmark."""
AFTER = slice(127500, 130500)
"""A weak part behind all splits, from which the noise is taken."""
TAPS = np.arange(-15, 250)
"""Delays [samples] of the linear filter that stands for any linear system."""
HERE = Path(__file__).parent
RUN = """vehicle: silverbox.yaml
title: "{title}"
band: [{low} Hz, {high} Hz]
step: 0.2048 ms
sample: 1.6384 ms
forces:
  V1: {{body: block, file: {name}_force.csv, time: t, force: F, unit: N, noise: {acting:.3e} N}}
sensors:
  V2: {{body: block, channels: {{displacement: {{column: y, noise: {sensed:.3e} m}}}}}}
recording: {name}.csv
"""


def read_silverbox(path: Path) -> tuple[Array, Array]:
    """Return force and displacement `shape (131072,)` [N, m], less the instruments' offsets: their means over the training part."""
    volts = np.loadtxt(path, delimiter=",", skiprows=1, usecols=(0, 1))
    return tuple((volts - volts[TRAINING].mean(axis=0)).T * np.array([[FORCE], [DISPLACEMENT]]))


def upsample(force: Array) -> Array:
    """Return the force at FINER times its rate: its spectrum ends at 200 Hz, so nothing is added between the samples."""
    return np.asarray(scipy.signal.resample(force, FINER * len(force)))


def noise_levels(force: Array, displacement: Array) -> tuple[float, float]:
    """Return the standard deviations [N, m] of white noise that acts beside the force, and of white noise in the displacement.

    What no linear filter H of the force explains behind the splits has the density 2 STEP (sigma_F^2 |H|^2 + sigma^2); both are
    most likely in Whittle's sense.
    """
    columns = np.column_stack([force[AFTER.start - i : AFTER.stop - i] for i in TAPS] + [np.ones(AFTER.stop - AFTER.start)])
    weights = np.linalg.lstsq(columns, displacement[AFTER])[0]
    left = displacement[AFTER] - columns @ weights
    frequency, density = scipy.signal.periodogram(left, 1 / STEP)
    inside = (frequency >= NOISE_BAND[0]) & (frequency <= NOISE_BAND[1])
    density = density[inside] * len(left) / (len(left) - columns.shape[1])
    response = np.exp(-2j * np.pi * STEP * np.outer(frequency[inside], TAPS)) @ weights[:-1]

    def loss(logarithms: Array) -> float:
        acting, sensed = np.exp(2 * logarithms)
        model = 2 * STEP * (acting * np.abs(response) ** 2 + sensed)
        return float(np.sum(np.log(model) + density / model))

    found = scipy.optimize.minimize(loss, np.log([1e-4 * FORCE, 1e-5 * DISPLACEMENT]), method="Nelder-Mead")
    acting, sensed = np.exp(found.x)
    return float(acting), float(sensed)


def write_runs(path: Path, folder: Path, runs: Mapping[str, tuple[int, int]]) -> list[Path]:
    """Write run files, recordings and forces of stretches (first sample, last + 1) by name, and return the run files."""
    force, displacement = read_silverbox(path)
    fine, (acting, sensed) = upsample(force), noise_levels(force, displacement)
    folder.mkdir(parents=True, exist_ok=True)
    shutil.copy(HERE / "silverbox.yaml", folder)
    written = []
    for name, (first, last) in runs.items():
        values = displacement[first:last]
        _write_columns(folder / f"{name}.csv", "t,y", np.column_stack([STEP * np.arange(len(values)), values]))
        values = fine[first * FINER : (last - 1) * FINER + 1]
        _write_columns(folder / f"{name}_force.csv", "t,F", np.column_stack([STEP / FINER * np.arange(len(values)), values]))
        title = f"Silverbox, samples {first} to {last - 1}"
        written.append(folder / f"{name}.yaml")
        write_text(written[-1], RUN.format(name=name, title=title, low=BAND[0], high=BAND[1], acting=acting, sensed=sensed))
    return written


def _write_columns(path: Path, header: str, columns: Array) -> None:
    write_text(path, header + "\n" + "".join(f"{t:.10g},{value:.8g}\n" for t, value in columns.tolist()))


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit("usage: python prepare.py SNLS80mV.csv FOLDER")
    for item in write_runs(Path(sys.argv[1]), Path(sys.argv[2]), RUNS | QUIET_RUNS):
        print(f"wrote {item}")
