"""A kernel cache of the tests' own, kept between runs and shared by all workers, instead of the user's."""

from __future__ import annotations

import getpass
import os
import tempfile
from pathlib import Path

import pytest
from hypothesis import settings

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
