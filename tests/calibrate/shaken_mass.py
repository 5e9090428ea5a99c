"""A mass on a spring and a damper to the ground, shaken by a measured force."""

import numpy as np

from vehgen.fit.problem import make_problem
from vehgen.fit.trial import load_trials

VEHICLE = """name: mass
gravity: false
parameters:
  M: {value: 110 kg, range: [40 kg, 200 kg]}
  c: {value: 150 N s/m, range: [50 N s/m, 600 N s/m]}
  k: {value: 30 kN/m, range: [10 kN/m, 90 kN/m]}
bodies: {mass: {mass: M, motions: [heave]}}
links: {spring: {ground: {}, mass: {}, c: c, k: k}}
"""
RUN = """vehicle: mass.yaml
step: 1 ms
sample: 5 ms
acquisition: none
forces: {shaker: {body: mass, file: force.csv, time: t, force: F, unit: N}}
sensors: {S: {body: mass, channels: {acceleration: a}}}
recording: recording.csv
"""
NOISE = 0.01
"""Of the sensor, as a share of what it reads."""


def shaken_mass(folder, told=""):
    """Return the problem of a shaken mass, recorded with noise, and the standard deviation of that noise; `told` ends its run file."""
    random, time = np.random.default_rng(0), np.arange(1600) * 0.005
    force = 200 * np.convolve(random.standard_normal(1600), np.ones(4) / 4, "same")
    np.savetxt(folder / "force.csv", np.column_stack([time, force]), delimiter=",", header="t,F", comments="")
    (folder / "mass.yaml").write_text(VEHICLE, encoding="utf-8")
    (folder / "run.yaml").write_text(RUN + told, encoding="utf-8")
    values = random.standard_normal(1600)
    for _ in range(2):  # the second time over what the first one simulates
        np.savetxt(folder / "recording.csv", np.column_stack([time, values]), delimiter=",", header="t,a", comments="")
        problem = make_problem(load_trials([folder / "run.yaml"]))
        exact = problem.respond(problem.space.start[None], problem.trials[0])[0][0, :, 0]
        sigma = NOISE * exact.std()
        values = exact + sigma * random.standard_normal(len(exact))
    return problem, sigma
