"""Measured forces and strokes of rigs in another unit, or the other way round, are found before any effect is looked for."""

import numpy as np
import pytest

from tests.diagnose.test_rigs import DYNO, STROKE, write
from vehgen.diagnose.detect.detection import detect
from vehgen.diagnose.inputs.judging import plain_mistakes
from vehgen.fit.trial import load_trials


def mistaken(path, factor):
    """Write the numbers of an input times a factor."""
    table = np.loadtxt(path, delimiter=",", skiprows=1)
    header = path.read_text(encoding="utf-8").splitlines()[0]
    table[:, 1] *= factor
    np.savetxt(path, table, delimiter=",", header=header, comments="", fmt="%.9g")


def told(runs):
    return plain_mistakes(detect(load_trials(runs)))


@pytest.mark.thorough
@pytest.mark.parametrize(
    ("factor", "only", "kind", "words"),
    [
        (1e-3, 3, "unit", "the force motor is 1000 times too small in all runs: its numbers are in kN, and taken as N"),
        (1 / 4.4482216, 1, "unit", "its numbers are in lbf, and taken as N"),
        (-1.0, 3, "turned", "the force motor acts the other way round in all runs than its column says"),
    ],
    ids=["kN", "lbf in one run", "sign"],
)
def test_a_force_in_another_unit_or_the_other_way_round_is_told(tmp_path, factor, only, kind, words):
    runs = write(tmp_path, 0.0)
    for run in runs[:only]:
        mistaken(run.with_name(f"{run.stem}_force.csv"), factor)
    (fault,) = told(runs)
    assert (fault.kind, fault.channels) == (kind, ("motor",))
    assert fault.runs == tuple(run.stem for run in runs[:only])
    assert words in fault.message


def strokes(folder):
    """Write three runs of a damper of 2 kN s/m with its load cell, and return them."""
    (folder / "dyno.yaml").write_text(DYNO, encoding="utf-8")
    random, runs = np.random.default_rng(3), []
    for name, amplitude, f in (("slow", 10e-3, 1.0), ("long", 20e-3, 1.5), ("fast", 5e-3, 3.0)):
        t = np.arange(0.0, 6.0, 1e-3)
        x = amplitude * (np.sin(2 * np.pi * f * t) + 0.3 * np.sin(5.4 * np.pi * f * t + 1)) * (1 - np.exp(-3 * t))
        np.savetxt(folder / f"{name}_stroke.csv", np.column_stack([t, x]), delimiter=",", header="t,x", comments="")
        force = -2e3 * np.gradient(x, t) + 2.0 * random.standard_normal(len(t))
        np.savetxt(folder / f"{name}.csv", np.column_stack([t, force])[::5], delimiter=",", header="t,F", comments="")
        (folder / f"{name}.yaml").write_text(STROKE.format(name=name), encoding="utf-8")
        runs.append(folder / f"{name}.yaml")
    return runs


@pytest.mark.thorough
@pytest.mark.parametrize(
    ("factor", "kind", "words", "cure"),
    [
        (1e3, "unit", "its numbers are in mm, and taken as m, or F is as much too small", "set `unit: mm` for it in the run file"),
        (1 / 0.0254, "unit", "its numbers are in in, and taken as m", "set `unit: in` for it in the run file"),
        (-1.0, "turned", "acts the other way round in all runs than its column says, or F has its sign turned", "turn the sign"),
    ],
)
def test_a_stroke_in_another_unit_or_the_other_way_round_is_told(tmp_path, factor, kind, words, cure):
    runs = strokes(tmp_path)
    for run in runs:
        mistaken(run.with_name(f"{run.stem}_stroke.csv"), factor)
    (fault,) = told(runs)
    assert (fault.kind, fault.channels) == (kind, ("damper",))
    assert words in fault.message
    assert cure in fault.cure


def test_inputs_that_are_right_are_no_fault(tmp_path):
    assert told(write(tmp_path, 20.0)) == ()
