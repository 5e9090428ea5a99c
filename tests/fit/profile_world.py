"""Recordings over a rough road that was measured, from scipy's integrator: no code is shared with the kernels."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import scipy.signal

from tests.fit.recordings import two_axle
from vehgen.fit.misfit import Misfit
from vehgen.fit.noise import EVEN, Noise
from vehgen.fit.nuisances import Nuisances
from vehgen.fit.problem import make_problem
from vehgen.fit.trial import Trial, load_trials

FINE, RATE = 40, 100.0
"""Exact steps of a sample, samples per second."""
SIGMA = np.array([0.02, 5e-4, 0.02, 5e-4])
"""Noise of the channels [m/s^2, rad/s]."""
SEARCHED = ("kf", "kr", "cf", "cr", "ktf", "ktr")
TRUTH = {
    "mH": 1500.0, "Lf": 1.18, "mf": 90.0, "mr": 150.0, "IZ": 2640.0, "kf": 62505.0,
    "kr": 71655.0, "cf": 3270.0, "cr": 4455.0, "ktf": 673140.0, "ktr": 612975.0,
}  # fmt: skip
"""The bundled sedan's own values."""
RUN = """vehicle: sedan2.yaml
speed: {speed} m/s
road: [{{profile: {{file: road.csv, distance: s, height: h}}}}]
duration: 8 s
sensors:
  F: {{body: body, behind: front, channels: {{acceleration: F_az, pitch_rate: F_q}}}}
  R: {{body: body, behind: rear, channels: {{acceleration: R_az, pitch_rate: R_q}}}}
recording: run.csv
"""

Array = np.ndarray
Road = tuple[Array, Array]
"""Distances and heights of a road's points [m]."""


def motion_matrices() -> tuple[Array, Array]:
    """Return the sedan's state matrix and its input matrix; states are the coordinates, then their rates."""
    mass, damping, stiffness, load = two_axle(TRUTH)
    inverse = np.linalg.inv(mass)
    a = np.block([[np.zeros((4, 4)), np.eye(4)], [-inverse @ stiffness, -inverse @ damping]])
    return a, np.vstack([np.zeros((4, 2)), inverse @ load])


def fine_channels(road: Road, speed: float, duration: float = 9.0) -> Array:
    """Return the sedan's channels every 1/(FINE RATE) s, by scipy.signal.lsim's first-order hold; it rests at t = 0."""
    a, b = motion_matrices()
    heave, pitch = a[4], a[5]
    rows, direct = [], []
    for place in (TRUTH["Lf"], TRUTH["Lf"] - 2.8):
        rows += [heave - place * pitch, np.eye(8)[5]]
        direct += [b[4] - place * b[5], np.zeros(2)]
    time = np.arange(int(duration * RATE * FINE)) / (RATE * FINE)
    wheels = np.column_stack([np.interp(speed * time - late, *road) - road[1][0] for late in (0.0, 2.8)])
    return scipy.signal.lsim((a, b, np.array(rows), np.array(direct)), wheels, time)[1]


def rough_road(seed: int = 0) -> Road:
    """Return a road of about ISO 8608 class B: a random walk of heights every 5 cm."""
    s = np.arange(0.0, 160.0, 0.05)
    return s, np.cumsum(np.random.default_rng(seed).standard_normal(len(s))) * 1.5e-3 * np.sqrt(0.05)


def write_run(folder: Path, sampled: Array, speed: float, road: Road, extra: str = "", late: float = 0.0, sigma: Array = SIGMA) -> Path:
    """Write the road and 8 s of samples with noise, on a clock that is `late` [s]; return the run file, which ends with `extra`."""
    np.savetxt(folder / "road.csv", np.column_stack(road), delimiter=",", header="s,h", comments="")
    values = sampled[: int(8 * RATE) + 1]
    values = values + sigma * np.random.default_rng(1).standard_normal(values.shape)
    rows = np.column_stack([np.arange(len(values)) / RATE + late, values])
    np.savetxt(folder / "run.csv", rows, delimiter=",", header="t,F_az,F_q,R_az,R_q", comments="")
    (folder / "run.yaml").write_text(RUN.format(speed=speed) + extra, encoding="utf-8")
    return folder / "run.yaml"


def read_run(folder: Path, sampled: Array, speed: float, road: Road, **options: object) -> Trial:
    """Return the trial of :func:`write_run`."""
    return load_trials([write_run(folder, sampled, speed, road, **options)])[0]


def misfit_of(trial: Trial, nuisances: Nuisances, sigma: Array = SIGMA) -> tuple[Misfit, Array]:
    """Return the misfit of a trial by SEARCHED in noise of `sigma`, and its unknowns at the truth."""
    problem = make_problem([trial], SEARCHED)
    misfit = Misfit(problem, {trial.name: Noise(EVEN, sigma)}, problem.space.start, nuisances, (0.5, 40.0))
    return misfit, np.concatenate([problem.space.unit(problem.space.start), np.zeros(misfit.n_errors)])


def low_passed(channels: Array, order: int, cut_off: float) -> Array:
    """Return samples of fine channels behind a Butterworth low-pass [Hz]."""
    return scipy.signal.sosfilt(scipy.signal.butter(order, cut_off, fs=RATE * FINE, output="sos"), channels, axis=0)[::FINE]
