"""The yardstick: the same recurrence by hand in C++ with vector types, compiled on the spot."""

from __future__ import annotations

import ctypes
import functools
import shutil
import subprocess
import tempfile
from pathlib import Path

import numpy as np

from benchmarks.peers.systems import Array, Systems

ORDER = ["mT", "mS", "IT", "IS", *(f"{kind}{i}" for kind in ("m", "k", "c", "kt") for i in range(1, 6)), "a1", "a2", "b1", "b6"]


def available() -> str | None:
    """Return why it cannot run, or None."""
    return None if shutil.which("g++") else "no C++ compiler (g++)"


@functools.cache
def _library() -> ctypes.CDLL:
    folder = Path(tempfile.mkdtemp(prefix="vehgen-yardstick-"))
    source, target = Path(__file__).with_name("kernel.cpp"), folder / "kernel.so"
    subprocess.run(
        [
            "g++",
            "-O3",
            "-march=native",
            "-mprefer-vector-width=512",
            "-ffp-contract=fast",
            "-fno-math-errno",
            "-shared",
            "-fPIC",
            "-pthread",
            source,
            "-o",
            target,
        ],
        check=True,
    )
    return ctypes.CDLL(str(target))


def prepare() -> None:
    """Compile."""
    _library()


def run(systems: Systems, inputs: Array, dt: float, keep: int, threads: int = 1) -> Array:
    """Return sensor accelerations, `shape (n_individuals, n_samples, 2)`."""
    parameters = np.ascontiguousarray([systems.parameters[name] for name in ORDER])
    n, steps = parameters.shape[1], len(inputs) - 1
    out = np.empty((n, steps // keep + 1, 2))
    inputs = np.ascontiguousarray(inputs)

    def pointer(array: Array) -> ctypes.c_void_p:
        return ctypes.c_void_p(array.ctypes.data)

    _library().simulate(
        pointer(parameters), ctypes.c_long(n), pointer(inputs), ctypes.c_long(steps), ctypes.c_double(dt), ctypes.c_long(keep),
        pointer(out), ctypes.c_int(threads),
    )  # fmt: skip
    return out
