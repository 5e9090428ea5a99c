"""A truck's runs for tests of what recordings cannot tell, and sets of its parameters that answer alike."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np

from vehgen.fit.least_squares import FIRST_NOISE, LeastSquaresFit, first_noises
from vehgen.fit.misfit import Misfit
from vehgen.fit.problem import Problem, make_problem
from vehgen.fit.trial import load_trials

SENSORS = {
    "both": """  L1: {body: tractor, behind: axle1, distance: -0.29 m, channels: {acceleration: az, pitch_rate: q}}
  L2: {body: semitrailer, behind: fifth_wheel, distance: 9.115 m, channels: {acceleration: bz, pitch_rate: r}}""",
    "one": "  L1: {body: tractor, behind: axle1, distance: -0.29 m, channels: {acceleration: az, pitch_rate: q}}",
}


def truck_problem(folder: Path, sensors: str = "both", vehicle: str = "tractor5.yaml", noise: float = FIRST_NOISE) -> Problem:
    """Return the problem of a run of a truck as its file has it, recorded with noise: a share of each channel's rms."""
    t = np.arange(1400) * 0.01
    random = np.random.default_rng(0).standard_normal((1400, 4))
    np.savetxt(folder / "run.csv", np.column_stack([t, random]), delimiter=",", header="t,az,q,bz,r", comments="")
    (folder / "run.yaml").write_text(
        f"vehicle: {vehicle}\nspeed: 2 m/s\n"
        "road: [{hump: {shape: half_sine, length: 0.5 m, height: 0.03 m, at: 4 m}}]\n"
        f"sensors:\n{SENSORS[sensors]}\nrecording: run.csv\n",
        encoding="utf-8",
    )
    problem = make_problem(load_trials([folder / "run.yaml"]))
    trial = problem.trials[0]
    values = problem.respond(problem.space.start[None], trial)[0][0]
    values = values + noise * np.sqrt(np.mean(values**2, axis=0)) * random[:, : values.shape[1]]
    return problem.with_trials([replace(trial, recording=replace(trial.recording, values=values))])


def fit_at(problem: Problem, values: np.ndarray) -> LeastSquaresFit:
    """Return what a fit would be that had ended at searched values, its runs as they are stated."""
    misfit = Misfit(problem, first_noises(problem), values)
    x = np.concatenate([problem.space.unit(values), np.zeros(misfit.n_unknowns - problem.space.size)])
    return LeastSquaresFit(misfit, x, float(np.mean(misfit.residuals(x) ** 2)), 0.0)


def along_the_first_direction(p: dict[str, float], mS: float) -> dict[str, float]:
    """Return another set that answers alike: a point mass at the hinge may belong to either body (all over mT)."""
    mT, old, new = 8000.0, p["mS"] / 8000.0, mS / 8000.0
    lam = (1 + new) / (1 + old)
    q = {name: value * lam for name, value in p.items() if name[0] in "mkc" and name not in ("mS", "mT")}
    b7 = (3.75 - p["b1"]) * lam
    q |= {"mS": mS, "b1": 3.75 - b7, "b6": p["b6"] * lam * old / new}
    mu, mu_new = old / (1 + old), new / (1 + new)
    q["a1"] = p["a1"]
    q["a2"] = lam * mu * p["a1"] * p["a2"] / (mu_new * q["a1"])
    JT = p["IT"] / mT + (3.75 - p["b1"]) ** 2 + mu * p["a1"] ** 2
    JS = p["IS"] / mT + p["b6"] ** 2 * old + mu * p["a2"] ** 2
    q["IT"] = mT * (lam * JT - b7**2 - mu_new * q["a1"] ** 2)
    q["IS"] = mT * (lam * JS - q["b6"] ** 2 * new - mu_new * q["a2"] ** 2)
    return q
