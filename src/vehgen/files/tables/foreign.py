"""Libraries of other formats: imported where a file needs them, and their failures told as faults of that file."""

from __future__ import annotations

import importlib
import warnings
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any, TypeVar

from vehgen.errors import InputError, shortened
from vehgen.files.reading import short_path

Item = TypeVar("Item")


def library(module: str, extra: str, path: Path) -> Any:
    """Return a module of an optional library; raises InputError that says how to install it, for the file that needs it."""
    try:
        with without_warnings():
            return importlib.import_module(module)
    except ImportError as error:
        raise InputError(f"reading {short_path(path)} needs {module.partition('.')[0]}: pip install 'vehgen[{extra}]'") from error


@contextmanager
def without_warnings() -> Iterator[None]:
    """Keep the warnings of libraries from the user: they are for who calls them."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        yield


@contextmanager
def faults_of(path: Path, kind: str) -> Iterator[None]:
    """Tell what a library cannot read as an InputError, without its warnings; `kind` is what was expected, e.g. `a Parquet file`.

    Only calls of the library belong into its block: what fails in other code is no fault of the file.
    """
    with without_warnings():
        try:
            yield
        except (InputError, MemoryError):
            raise
        except Exception as error:  # a damaged file fails in such libraries in ways that none of them lists
            raise _refusal(path, kind, error) from error


def items_of(items: Iterable[Item], path: Path, kind: str) -> Iterator[Item]:
    """Yield what a library reads piece by piece, its faults told as by :func:`faults_of`; those of who takes the pieces are their own."""
    try:
        yield from items
    except (InputError, MemoryError):
        raise
    except Exception as error:  # as above
        raise _refusal(path, kind, error) from error


def _refusal(path: Path, kind: str, error: Exception) -> InputError:
    said = shortened(" ".join(str(error).split())) or type(error).__name__
    return InputError(f"{short_path(path)} cannot be read as {kind}: {said}")
