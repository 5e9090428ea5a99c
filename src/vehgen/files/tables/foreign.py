"""Libraries of other formats: imported where a file needs them, and their failures told as faults of that file."""

from __future__ import annotations

import importlib
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from vehgen.errors import InputError, shortened
from vehgen.files.reading import short_path


def library(module: str, extra: str, path: Path) -> Any:
    """Return a module of an optional library; raises InputError that says how to install it, for the file that needs it."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            return importlib.import_module(module)
    except ImportError as error:
        raise InputError(f"reading {short_path(path)} needs {module.partition('.')[0]}: pip install 'vehgen[{extra}]'") from error


@contextmanager
def faults_of(path: Path, kind: str) -> Iterator[None]:
    """Tell what a library cannot read as an InputError; `kind` is what was expected, e.g. `a Parquet file`.

    Its warnings are not for the user.
    """
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        try:
            yield
        except (InputError, MemoryError):
            raise
        except Exception as error:  # a damaged file fails in such libraries in ways that none of them lists
            said = shortened(" ".join(str(error).split())) or type(error).__name__
            raise InputError(f"{short_path(path)} cannot be read as {kind}: {said}") from error
