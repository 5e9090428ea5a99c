"""How does a process for pieces of work begin? With what this one has imported, where it can be forked safely; else afresh.

To import what a diagnosis needs takes longer than many a piece of work. Python's fork server, a process that does nothing else, imports
it once, and every process of work is a fork of it. Elsewhere than on Linux system libraries may not survive a fork, and Python before
3.11.1 let other users of the machine speak to its server (CVE-2022-42919): there each process starts afresh (spawn).
"""

from __future__ import annotations

import multiprocessing
import signal
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from multiprocessing import resource_tracker
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from multiprocessing.context import ForkServerContext, SpawnContext

FORKED = sys.platform == "linux" and sys.version_info >= (3, 11, 1)
"""Whether processes of work are forks of a server's process."""
IMPORTED_BEFORE = {"vehgen", "numpy", "scipy", "sympy", "numba", "llvmlite", "threadpoolctl"}
"""Packages of which the server imports what this process has imported when it first asks for another one ..."""
NO_WORK = ("vehgen.commands", "vehgen.report")
"""... without the rooms that no piece of work enters: they bring what draws figures and tables."""


def process_context() -> ForkServerContext | SpawnContext:
    """Return the context of :mod:`multiprocessing` in which processes for pieces of work begin.

    Neither kind copies this process: the module that it runs as a script is imported by each, and a script needs the usual
    `if __name__ == "__main__":` around its work. Where the server cannot be reached, as by too long a name of the temporary folder, each
    process starts afresh.
    """
    if FORKED:
        from multiprocessing.forkserver import ensure_running

        context = multiprocessing.get_context("forkserver")
        context.set_forkserver_preload([name for name in sys.modules if _is_for_work(name)])
        try:
            with uninterrupted():
                ensure_running()
        except OSError:
            return multiprocessing.get_context("spawn")
        return context
    return multiprocessing.get_context("spawn")


@contextmanager
def uninterrupted() -> Iterator[None]:
    """Begin processes that Ctrl-C passes by from their first moment on; here it comes when the block ends."""
    if not hasattr(signal, "pthread_sigmask"):
        yield
        return
    resource_tracker.ensure_running()  # when it begins, it lets Ctrl-C through
    former = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, former)


def _is_for_work(name: str) -> bool:
    package, *inner = name.split(".")
    if package not in IMPORTED_BEFORE or any(part.startswith("_") for part in inner) or name.startswith(NO_WORK):
        return False
    return package == "vehgen" or len(inner) <= 1
