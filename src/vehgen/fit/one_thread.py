"""BLAS on one thread: the matrices of fits are small, and more threads would only wait for one another."""

from __future__ import annotations

from contextlib import AbstractContextManager
from functools import cache
from importlib import import_module
from typing import Any

from threadpoolctl import ThreadpoolController


def one_blas_thread() -> AbstractContextManager[Any]:
    """Return a context in which numpy's and scipy's linear algebra runs on one thread."""
    limit: AbstractContextManager[Any] = _libraries().limit(limits=1, user_api="blas")
    return limit


@cache
def _libraries() -> ThreadpoolController:
    """Return the libraries that are limited; looking them up takes as long as a small fit's step."""
    import_module("scipy.linalg")  # which brings a BLAS of its own
    return ThreadpoolController()
