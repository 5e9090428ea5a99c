"""Roads, sampling, noise, and the files of a trial."""

from __future__ import annotations

import csv
import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from benchmarks.hidden_effects import generator
from benchmarks.hidden_effects.generator import (
    SILENT,
    Case,
    Effect,
    Hump,
    Noise,
    RandomRoad,
    RunSpec,
    nominal,
    perturbed,
    simulate_case,
    write_case,
)
from benchmarks.hidden_effects.generator.roads import HalfSine, Points, Road, random_road
from benchmarks.hidden_effects.generator.vehicles import NOMINAL
from scipy import signal

from vehgen.vehicle import load_vehicle

ROUGH = RunSpec((RandomRoad("B", 3), Hump(0.5, 0.03, 6.0)), 5.0, 4.0, "rough")


def test_nothing_of_vehgen_is_imported():
    for file in Path(generator.__file__).parent.rglob("*.py"):
        lines = [line for line in file.read_text().splitlines() if line.lstrip().startswith(("import ", "from "))]
        assert not any("vehgen" in line for line in lines), file


def test_numbers_are_those_of_the_model_files():
    for name, table in NOMINAL.items():
        parameters = load_vehicle(f"{name}.yaml").parameters
        stated = {key: parameter for key, parameter in parameters.items() if parameter.value is not None}
        assert set(stated) == set(table)
        for key, parameter in stated.items():
            assert parameter.value.evaluate({}) == pytest.approx(table[key].value, rel=1e-12), key
            assert (parameter.range is None) == (table[key].range is None), key
            if parameter.range is not None:
                assert [bound.evaluate({}) for bound in parameter.range] == pytest.approx(table[key].range), key


def test_perturbation_touches_what_can_be_calibrated():
    one, other, base = perturbed("tractor5", 1), perturbed("tractor5", 2), nominal("tractor5")
    assert one != other
    assert one == perturbed("tractor5", 1)
    for name, parameter in NOMINAL["tractor5"].items():
        assert (one[name] == base[name]) == (parameter.range is None)
    changes = [np.log(perturbed("tractor5", seed)["k3"] / base["k3"]) for seed in range(200)]
    assert np.std(changes) == pytest.approx(0.05, rel=0.15)


def test_footprint_is_the_mean_of_the_road():
    rng = np.random.default_rng(0)
    s = np.cumsum(rng.uniform(0.01, 0.1, 60))
    parts = (HalfSine(0.4, 0.03, 1.0), Points(s, rng.standard_normal(60) * 0.01))
    at = np.array([-1.0, 0.05, 0.95, 1.1, 1.38, 2.0, s[-1] + 0.05, 9.0])
    fine = np.linspace(-0.12, 0.12, 40001)
    expected = [np.mean(Road(parts).heights(x + fine)) for x in at]
    np.testing.assert_allclose(Road(parts, 0.24).heights(at), expected, atol=2e-6)


def test_random_road_has_the_psd_of_its_class():
    psds = []
    for seed in range(12):
        road = random_road("B", 0.0, 400.0, np.random.default_rng(seed), taper=False)
        f, psd = signal.welch(road.height, 100.0, nperseg=8192)
        psds.append(psd)
    inside = (f > 0.05) & (f < 2.0)
    assert np.mean(np.mean(psds, axis=0)[inside] / (64e-6 * (f[inside] / 0.1) ** -2)) == pytest.approx(1.0, rel=0.1)


def test_truth_differs_from_belief_as_told():
    base = RunSpec((Hump(0.5, 0.03, 2.0),), 3.0, 3.0)
    p = nominal("sedan2")

    def clean(**errors):
        return simulate_case(Case("sedan2", p, (), (RunSpec(base.road, 3.0, 3.0, **errors),), noise=SILENT))[0].clean["F_az"]

    np.testing.assert_allclose(clean(hump_height_error=0.03), 1.03 * clean(), atol=1e-12)
    np.testing.assert_allclose(clean(arrival_shift=0.05)[5:], clean()[:-5], atol=1e-10)
    longer = simulate_case(Case("sedan2", p, (), (RunSpec((Hump(0.55, 0.03, 2.0),), 3.0, 3.0),), noise=SILENT))[0].clean["F_az"]
    np.testing.assert_allclose(clean(hump_length_error=0.1), longer, atol=1e-12)
    hidden = clean(hidden_roughness="A")
    assert np.std(hidden[:50]) > 0.01
    assert np.std(clean()[:50]) == 0.0


def test_noise_has_its_size_and_colour():
    case = Case("sedan2", runs=(RunSpec((Hump(0.5, 0.03, 2.0),), 3.0, 30.0),), noise=Noise(0.02, 0.001, 0.0))
    recording = simulate_case(case)[0]
    for name, sigma in (("F_az", 0.02), ("R_q", 0.001)):
        error = recording.channels[name] - recording.clean[name]
        assert recording.sigma[name] == sigma
        assert np.std(error) == pytest.approx(sigma, rel=0.05)
    assert np.array_equal(simulate_case(case)[0].channels["F_az"], recording.channels["F_az"])
    pink = simulate_case(Case("sedan2", runs=case.runs, noise=Noise(0.02, 0.001, 0.0, colour=1.0)))[0]
    f, psd = signal.welch(pink.channels["F_az"] - pink.clean["F_az"], 100.0, nperseg=512)
    slope = np.polyfit(np.log(f[2:-2]), np.log(psd[2:-2]), 1)[0]
    assert slope == pytest.approx(-1.0, abs=0.2)


def test_filtered_sampling_keeps_the_pass_band():
    runs = (RunSpec((Hump(0.5, 0.03, 2.0),), 3.0, 4.0),)
    point = simulate_case(Case("sedan2", runs=runs, noise=SILENT))[0].clean
    smooth = simulate_case(Case("sedan2", runs=runs, noise=SILENT, sampling="filtered"))[0].clean
    for name in point:
        one, other = np.fft.rfft(point[name]), np.fft.rfft(smooth[name])
        f = np.fft.rfftfreq(len(point[name]), 0.01)
        band = f < 30
        assert np.linalg.norm((one - other)[band]) < 0.02 * np.linalg.norm(one[band])


def read(path):
    with open(path, newline="") as file:
        rows = list(csv.reader(file))
    return dict(zip(rows[0], np.array(rows[1:], dtype=float).T, strict=True))


def test_files_of_a_case(tmp_path):
    case = Case("sedan2", effects=(Effect("relaxation", "rear", {"k": 5e4, "time": 0.1}),), runs=(ROUGH, ROUGH), seed=7)
    paths = write_case(case, tmp_path / "seen", tmp_path / "hidden")
    assert [path.name for path in paths] == ["rough1.yaml", "rough2.yaml"]
    assert sorted(path.name for path in (tmp_path / "seen").iterdir()) == sorted(
        f"rough{i}{end}" for i in (1, 2) for end in (".csv", ".yaml", "_road1.csv")
    )
    columns = read(tmp_path / "seen" / "rough1.csv")
    assert list(columns) == ["t", "F_az", "F_q", "R_az", "R_q"]
    np.testing.assert_allclose(columns["F_az"], simulate_case(case)[0].channels["F_az"], rtol=1e-8)
    truth = json.loads((tmp_path / "hidden" / "truth.json").read_text())
    assert truth["effects"] == [{"name": "relaxation", "place": "rear", "values": {"k": 5e4, "time": 0.1}}]
    assert truth["parameters"] == perturbed("sedan2", 7)
    assert "relaxation" not in "".join(path.read_text() for path in (tmp_path / "seen").iterdir())


SEDAN_LAWS = """\
extends: sedan2.yaml
axles:
  front: {suspension: {laws: [{cubic_stiffness: {k3: 1e8 N/m^3}}, {relaxation: {k: 40 kN/m, time: 0.05 s}}]}}
  rear:
    suspension: {laws: [{dry_friction: {force: 300 N}}, {quadratic_damping: {c2: 2000 N s^2/m^2}}]}
    tyre: {laws: [{tyre_liftoff: {}}]}
"""
TRACTOR_HINGE = """\
extends: tractor5.yaml
hinges: {fifth_wheel: {k: 2 MN m/rad}}
"""
TRACTOR_FRAME = """\
extends: tractor5.yaml
bodies: {semitrailer: {bending: {length: sqrt(12*IS/mS), frequency: 5.5 Hz, damping_ratio: 0.02, z: a2}}}
"""


@pytest.mark.thorough
@pytest.mark.parametrize(
    ("vehicle", "text", "effects", "run"),
    [
        (
            "sedan2", SEDAN_LAWS,
            (
                Effect("cubic_stiffness", "front", {"k3": 1e8}), Effect("relaxation", "front", {"k": 4e4, "time": 0.05}),
                Effect("dry_friction", "rear", {"force": 300.0}), Effect("quadratic_damping", "rear", {"c2": 2e3}),
                Effect("tyre_liftoff", "rear", {"share": 1.0}),
            ),
            RunSpec((Hump(0.5, 0.06, 2.0), RandomRoad("A", 5)), 4.0, 4.0),
        ),
        (
            "tractor5", TRACTOR_HINGE,
            (
                Effect("hinge_stiffness", "fifth_wheel", {"k": 2e6}),
            ),
            RunSpec((Hump(0.5, 0.03, 2.0),), 2.0, 10.0),
        ),
        (
            "tractor5", TRACTOR_FRAME,
            (
                Effect("frame_bending", "semitrailer", {"frequency": 5.5, "damping": 0.02, "modal_mass_share": 0.8, "participation": 1.0}),
            ),
            RunSpec((Hump(0.5, 0.03, 2.0),), 2.0, 10.0),
        ),
    ],
    ids=["sedan2", "hinge", "frame"],
)  # fmt: skip
def test_vehgen_reads_the_files_and_computes_the_same(tmp_path, vehicle, text, effects, run):
    path = write_case(Case(vehicle, nominal(vehicle), effects, (run,), noise=SILENT), tmp_path)[0]
    (tmp_path / "truth.yaml").write_text(text)
    path.write_text(path.read_text().replace(f"vehicle: {vehicle}.yaml", "vehicle: truth.yaml\nstep: 0.25 ms\nsample: 10 ms"))
    out = tmp_path / "out.csv"
    done = subprocess.run(
        [sys.executable, "-m", "vehgen", "simulate", str(path), "--out", str(out)], capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
    theirs, ours = read(out), read(path.with_suffix(".csv"))
    for name in ours:
        if name != "t":
            assert np.linalg.norm(theirs[name] - ours[name]) < 2e-3 * np.linalg.norm(ours[name])
