"""The tables of timed jobs, and where a sampled stack counts."""

import json
import subprocess
import sys

import pytest
from benchmarks.jobs import sampler
from benchmarks.jobs.inputs import ROOT
from benchmarks.jobs.sampler import place
from benchmarks.jobs.tables import Taken, shortest, split, totals

OLD = Taken(20.0, {"search": 15.0, "polish": 5.0}, {"fit": 5.0, "measure": 15.0})
NEW = Taken(10.0, {"search": 4.0, "figures": 6.0, "imports": 0.01}, {"fit": 10.0})


def test_the_shortest_round_counts():
    assert shortest([OLD, NEW]) is NEW


def test_totals_of_two_checkouts_have_their_ratio():
    assert totals({"dhcm": [OLD, NEW]}) == [
        "| job | against [s] | here [s] | ratio |",
        "| --- | --- | --- | --- |",
        "| dhcm | 20.0 | 10.0 | 0.50 |",
    ]


def test_totals_of_one_checkout():
    assert totals({"dhcm": [NEW]})[-1] == "| dhcm | 10.0 |"


def test_a_split_has_a_row_for_every_part_of_either_the_largest_first():
    assert split({"dhcm": [OLD, NEW]}, "stages") == [
        "| CPU [s] by stage | dhcm |",
        "| --- | --- |",
        "| search | 15.0 → 4.0 |",
        "| figures | 0.0 → 6.0 |",
        "| polish | 5.0 → 0.0 |",
    ]


V = "/home/x/src/vehgen"


@pytest.mark.parametrize(
    ("files", "expected"),
    [
        (["/lib/numpy/fft.py", f"{V}/measure/spectra.py", f"{V}/calibrate/genetic/search.py"], ("search", "measure")),
        ([f"{V}/codegen/kernel.py", f"{V}/fit/misfit.py", f"{V}/calibrate/polish.py"], ("polish", "codegen: kernels")),
        ([f"{V}/identify/genetic/search.py", f"{V}/identify/calibration.py"], ("search", "calibrate")),
        ([f"{V}/codegen/residual.py", f"{V}/diagnose/api.py"], ("the rest", "codegen")),
        (["<frozen importlib._bootstrap>", f"{V}/__init__.py", f"{V}/diagnose/api.py"], ("imports", "imports")),
        (["/lib/numba/core/lowering.py", f"{V}/codegen/cache.py", f"{V}/calibrate/polish.py"], ("polish", "compiling")),
        (["/usr/lib/python3.11/runpy.py"], ("the rest", "the rest")),
    ],
)
def test_a_stack_counts_for_the_innermost_room_and_its_stage(files, expected):
    assert place(files) == expected


def test_sampled_seconds_add_up_to_what_a_command_took(tmp_path):
    told = tmp_path / "told.json"
    arguments = [sys.executable, sampler.__file__, str(told), "modes", "tractor5", "--json"]
    environment = {"PYTHONPATH": str(ROOT / "src"), "VEHGEN_CACHE": str(tmp_path)}
    printed = subprocess.run(arguments, env=environment, capture_output=True, encoding="utf-8", check=True).stdout
    assert "tractor pitch" in printed
    found = json.loads(told.read_text())
    for kind in ("stages", "rooms"):
        assert sum(found[kind].values()) == pytest.approx(found["cpu"], rel=0.1)
    assert found["rooms"]["imports"] > 0.05
