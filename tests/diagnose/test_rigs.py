"""A carriage that a motor drives along a rail, simulated by another hand's rules: friction that truly sticks, a ripple, a false zero."""

from types import SimpleNamespace

import numpy as np
import pytest

from vehgen.diagnose.api import diagnose
from vehgen.fit.rig_noise import RigNoiseSearch, unstated_sizes

VEHICLE = """name: carriage
gravity: false
parameters:
  M: {value: 110 kg, range: [40 kg, 200 kg]}
  c: {value: 150 N s/m, range: [50 N s/m, 600 N s/m]}
bodies: {carriage: {mass: M, motions: [heave]}}
links: {rail: {ground: {}, carriage: {}, c: c}}
"""
RUN = """vehicle: carriage.yaml
step: 1 ms
sample: 10 ms
acquisition: none
forces: {{motor: {{body: carriage, file: {name}_force.csv, time: t, force: F, unit: N}}}}
sensors: {{encoder: {{body: carriage, channels: {{displacement: q}}}}}}
recording: {name}.csv
"""
MASS, DAMPING, FINE = 90.0, 200.0, 10
OFFSET = 3.0
"""What acts beside the recorded force [N]."""


def drive(friction, amplitude, seed, spring=0.0, seconds=6.0, dt=1e-3):
    """Return times, recorded forces and places of a carriage under a position controller; Karnopp's friction, explicit small steps."""
    random = np.random.default_rng(seed)
    t = np.arange(0.0, seconds + dt / 2, dt)
    asked = amplitude * (1 - np.cos(2 * np.pi * t / 3.0)) / 2 + 0.05 * amplitude * np.sin(2 * np.pi * 1.7 * t)
    ripple = np.convolve(random.standard_normal(len(t)), np.ones(10) / 10, "same") * 2.0
    q = v = 0.0
    beside = 0.0 if spring else OFFSET  # what a spring holds has settled
    force, place, h = np.zeros(len(t)), np.zeros(len(t)), dt / FINE
    for i in range(len(t)):
        place[i] = q
        force[i] = np.clip(4e3 * (asked[i] - q) - 900.0 * v, -150, 150)
        for _ in range(FINE):
            push = force[i] + ripple[i] + beside - spring * q
            if abs(v) < 1e-5 and abs(push) <= friction:
                v = 0.0
            else:
                slide = friction * np.sign(v if abs(v) >= 1e-5 else push)
                new = v + h * (push - DAMPING * v - slide) / MASS
                v = 0.0 if new * v < 0 and abs(push) <= friction else new
            q += h * v
    return t, force, place


def write(folder, friction, amplitudes=(0.15, 0.25, 0.2), cell=0.0, spring=0.0, zero=0.0):
    """Write runs of the carriage; `cell` is the noise of what measures its force [N], `zero` what that reads of none [N]."""
    (folder / "carriage.yaml").write_text(VEHICLE, encoding="utf-8")
    runs = []
    for number, amplitude in enumerate(amplitudes):
        name = f"run{number}"
        t, force, place = drive(friction, amplitude, number, spring)
        held = np.column_stack([t, force + zero + cell * np.random.default_rng(number + 90).standard_normal(len(t))])
        np.savetxt(folder / f"{name}_force.csv", held, delimiter=",", header="t,F", comments="", fmt="%.9g")
        recorded = place + 1e-6 * np.random.default_rng(number + 50).standard_normal(len(t))
        np.savetxt(folder / f"{name}.csv", np.column_stack([t, recorded])[::10], delimiter=",", header="t,q", comments="", fmt="%.9g")
        (folder / f"{name}.yaml").write_text(RUN.format(name=name), encoding="utf-8")
        runs.append(folder / f"{name}.yaml")
    return runs


@pytest.mark.slow
def test_friction_of_a_driven_carriage_is_named_with_the_force_beside_the_recorded_one(tmp_path):
    runs = write(tmp_path, 20.0)
    found = diagnose(tmp_path / "carriage.yaml", runs)
    assert (found.verdict.verdict, [item.name for item in found.verdict.effects]) == ("named", ["dry_friction"])
    force = found.verdict.effects[0].parameters["force"]
    assert force.value == pytest.approx(20.0, rel=0.1)
    zero = next(item for item in found.models.chosen[-1].least_squares.conditions() if item.name == "force_offset")
    assert zero.value == pytest.approx(OFFSET, abs=0.6)
    assert any("constant force" in note for note in found.verdict.notes)
    (note,) = [note for note in found.verdict.notes if note.startswith("asymmetric dry friction in the link rail")]
    assert "would do as well" in note


@pytest.mark.thorough
def test_a_carriage_without_friction_lacks_nothing(tmp_path):
    assert diagnose(tmp_path / "carriage.yaml", write(tmp_path, 0.0)).verdict.verdict == "no_missing_effect"


@pytest.mark.thorough
def test_a_load_cells_noise_is_as_loud_in_gentle_runs(tmp_path):
    found = diagnose(tmp_path / "carriage.yaml", write(tmp_path, 0.0, (0.07, 0.25, 0.12, 0.18), cell=2.0))
    assert found.verdict.verdict == "no_missing_effect"
    assert max(item.after for item in found.verdict.gap.runs) < 1.15


@pytest.mark.slow
def test_a_spring_where_the_file_has_none_is_named(tmp_path):
    verdict = diagnose(tmp_path / "carriage.yaml", write(tmp_path, 0.0, spring=100.0, zero=1.5)).verdict
    assert (verdict.verdict, [item.name for item in verdict.effects]) == ("named", ["added_stiffness"])
    assert verdict.effects[0].parameters["k"].value == pytest.approx(100.0, rel=0.05)


DYNO = """name: dyno
gravity: false
parameters: {c: {value: 2.6 kN s/m, range: [0.3 kN s/m, 8 kN s/m]}}
bodies: {head: {mass: 5 kg, motions: [heave]}}
links:
  damper: {ground: {}, head: {}, c: c}
  load_cell: {head: {}, ground: {}, k: 50 MN/m, c: 5 kN s/m}
"""
STROKE = """vehicle: dyno.yaml
step: 0.5 ms
sample: 5 ms
acquisition: none
displacements: {{damper: {{file: {name}_stroke.csv, time: t, displacement: x, unit: m}}}}
sensors: {{cell: {{link: load_cell, channels: {{link_force: F}}}}}}
recording: {name}.csv
"""


def stroke(folder, compressed, extended, rest, zero=0.0):
    """Write three runs of a damper whose friction slips at these forces [N], each after a rest [s]; return the run files.

    `zero` is what the load cell reads without a force [N].
    """
    (folder / "dyno.yaml").write_text(DYNO, encoding="utf-8")
    random, runs = np.random.default_rng(3), []
    for name, amplitude, f in (("slow", 10e-3, 1.0), ("long", 20e-3, 1.5), ("fast", 5e-3, 3.0)):
        t = np.arange(0.0, 6.0 + rest, 1e-3)
        s = np.maximum(t - rest, 0.0)
        x = amplitude * (np.sin(2 * np.pi * f * s) + 0.3 * np.sin(5.4 * np.pi * f * s + 1)) * (1 - np.exp(-3 * s))
        v = np.gradient(x, t)
        slip = np.where(v > 0, compressed, np.where(v < 0, -extended, 0.0))
        force = -(2e3 * v + slip)  # the load cell is stiff: it reads what the damper passes on
        np.savetxt(folder / f"{name}_stroke.csv", np.column_stack([t, x]), delimiter=",", header="t,x", comments="")
        noisy = np.column_stack([t, force + zero + 2.0 * random.standard_normal(len(t))])[::5]
        np.savetxt(folder / f"{name}.csv", noisy, delimiter=",", header="t,F", comments="")
        (folder / f"{name}.yaml").write_text(STROKE.format(name=name), encoding="utf-8")
        runs.append(folder / f"{name}.yaml")
    return runs


@pytest.mark.thorough
def test_friction_of_a_damper_is_named_from_its_load_cell(tmp_path):
    verdict = diagnose(tmp_path / "dyno.yaml", stroke(tmp_path, 80.0, 80.0, 0.0)).verdict
    assert (verdict.verdict, [item.name for item in verdict.effects]) == ("named", ["dry_friction"])
    assert verdict.effects[0].parameters["force"].value == pytest.approx(80.0, rel=0.05)
    assert 0.8 < verdict.gap.after < 1.3


@pytest.mark.thorough
@pytest.mark.parametrize(("friction", "expected"), [(0.0, []), (80.0, ["dry_friction"])])
def test_a_false_zero_of_the_load_cell_says_nothing_of_the_damper(tmp_path, friction, expected):
    verdict = diagnose(tmp_path / "dyno.yaml", stroke(tmp_path, friction, friction, 0.0, zero=12.0)).verdict
    assert (verdict.verdict, [item.name for item in verdict.effects]) == ("named" if expected else "no_missing_effect", expected)
    assert verdict.gap.after < 1.3


@pytest.mark.slow
def test_friction_that_is_stronger_one_way_is_named_where_the_damper_begins_at_rest(tmp_path):
    verdict = diagnose(tmp_path / "dyno.yaml", stroke(tmp_path, 80.0, 50.0, 1.5)).verdict
    assert (verdict.verdict, [item.name for item in verdict.effects]) == ("named", ["asymmetric_friction"])
    found = verdict.effects[0].parameters
    assert found["force"].value == pytest.approx(65.0, rel=0.05)
    assert found["ratio"].value == pytest.approx(1.6, rel=0.1)
    assert 0.8 < verdict.gap.after < 1.3


def test_runs_that_other_forces_drive_have_errors_by_name(tmp_path):
    """Two forces in two runs, in another order, one in a third, none in a fourth: each keeps its own size."""
    runs = [Driven("both", {"ram": 100.0, "fan": 50.0}), Driven("turned", {"fan": 60.0, "ram": 80.0}), Driven("one", {"fan": 5.0})]
    sizes = [unstated_sizes(item.trial) for item in runs]
    assert sizes[1] == {"fan": pytest.approx(60.0), "ram": pytest.approx(80.0)}
    found = RigNoiseSearch.of(
        [*runs, Driven("none", {})], {}, {name: SimpleNamespace(sigma=np.ones(1)) for name in ("both", "turned", "one", "none")}
    )
    shares, alike = (item.forces for item in found)
    assert shares["one"] == pytest.approx([5.0])
    assert alike["turned"] == pytest.approx([60.0, 100.0])
    assert alike["one"] == pytest.approx([60.0])
    assert alike["none"].size == shares["none"].size == 0


class Driven:
    """What a search reads of a run that forces of these standard deviations drive."""

    def __init__(self, name, forces):
        values = [SimpleNamespace(values=size * np.array([1.0, -1.0])) for size in forces.values()]
        entries = {force: SimpleNamespace(noise=None) for force in forces}
        recording = SimpleNamespace(channels=[SimpleNamespace(noise=None)])
        run = SimpleNamespace(file=SimpleNamespace(forces=entries))
        self.trial = SimpleNamespace(name=name, recording=recording, run=run, scenario=SimpleNamespace(forces=values))
