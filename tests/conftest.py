"""A kernel cache of the tests' own, kept between runs and shared by all workers, instead of the user's."""

from __future__ import annotations

import getpass
import os
import tempfile
from pathlib import Path

import pytest
from hypothesis import settings

# one thread a worker, before numpy is imported: threads of several workers wait for one another, and matrices here are small
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

UNTRACED = (
    "codegen/test_laws.py",
    "commands/test_ends.py",
    "diagnose/test_alternatives.py",
    "diagnose/test_beyond_belief.py",
    "diagnose/test_drawn_roughness.py",
    "diagnose/test_early_end.py",
    "diagnose/test_elsewhere.py",
    "diagnose/test_emps.py",
    "diagnose/test_faults.py",
    "diagnose/test_fleet.py",
    "diagnose/test_freed_base.py",
    "diagnose/test_groups.py",
    "diagnose/test_jumps.py",
    "diagnose/test_look_again.py",
    "diagnose/test_releases.py",
    "diagnose/test_rigs.py",
    "diagnose/test_screening.py",
    "diagnose/test_shortlist.py",
    "diagnose/test_silverbox.py",
    "diagnose/test_special_cases.py",
    "diagnose/test_tyre_damping.py",
    "diagnose/test_unknown_hump.py",
    "docs/test_api.py",
    "docs/test_snippets.py",
    "effects/test_library.py",
    "export/test_c.py",
    "export/test_data_files.py",
    "export/test_fmu.py",
    "files/test_expression_trees.py",
    "fuzzing",
    "hidden_effects",
    "measured_world",
    "mechanics/test_equilibrium.py",
    "mechanics/test_hinge_forces.py",
    "mechanics/test_random_layouts.py",
    "report/test_drawing.py",
    "test_architecture.py",
    "test_public_names.py",
    "test_suite.py",
    "unchanged",
    "vehicle/test_fuzz.py",
)
"""Tests that no coverage is measured of: long ones whose lines of vehgen others run too, and what reads or runs other code. A tracer would
make them half as long again, or twice as long."""

settings.register_profile("whole", deadline=None)  # a busy machine is no fault of an example
settings.load_profile("whole")


def pytest_configure(config: pytest.Config) -> None:
    """Choose the folder before any test starts a process; a VEHGEN_CACHE that is already set stays."""
    if "VEHGEN_CACHE" in os.environ:
        return
    cache = getattr(config, "cache", None)  # absent with -p no:cacheprovider
    folder = Path(tempfile.gettempdir()) / f"vehgen_tests_{getpass.getuser()}" if cache is None else cache.mkdir("vehgen_kernels")
    folder.mkdir(mode=0o700, exist_ok=True)
    folder.chmod(0o700)
    os.environ["VEHGEN_CACHE"] = str(folder)


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Mark what coverage passes over."""
    places = [Path(__file__).parent / name for name in UNTRACED]
    for item in items:
        if any(item.path.is_relative_to(place) for place in places):
            item.add_marker(pytest.mark.no_cover)
