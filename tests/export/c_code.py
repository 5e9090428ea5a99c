"""Exported C in tests: compiled with every warning an error, and driven through ctypes."""

from __future__ import annotations

import ctypes
import shutil
import subprocess

import numpy as np
import pytest

from vehgen.codegen import Excitation, Kernel

COMPILERS = [name for name in ("gcc", "clang") if shutil.which(name)]
STRICT = ["-std=c99", "-pedantic", "-Wall", "-Wextra", "-Werror", "-O1"]
needs_compiler = pytest.mark.skipif(not COMPILERS, reason="no C compiler is installed")
Doubles = ctypes.POINTER(ctypes.c_double)


def compile_c(sources, target, *options, compiler=None):
    """Compile sources to a program or, with -shared, to a library."""
    command = [compiler or COMPILERS[0], *STRICT, *options, "-o", str(target), *map(str, sources), "-lm"]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert (done.returncode, done.stderr) == (0, "")
    return target


def doubles(array):
    return array.ctypes.data_as(Doubles)


class Library:
    """An exported vehicle as a loaded library."""

    def __init__(self, header, compiler=None, *options):
        self.prefix = header.stem
        text = header.read_text(encoding="ascii")
        self.count = lambda name: int(text.split(f"#define {self.prefix.upper()}_{name} ")[1].split()[0])
        target = compile_c([header.with_suffix(".c")], header.with_suffix(".so"), "-shared", "-fPIC", *options, compiler=compiler)
        self.library = ctypes.CDLL(str(target))
        lengths = (1, self.count("ALL_PARAMETERS_LENGTH"), self.count("CONSTANTS_LENGTH"), self.count("N_STATES"))
        self.model = np.full(sum(lengths), np.nan)
        for name in ("setup", "reset", "step", "outputs", "residual", "check"):
            getattr(self.library, f"{self.prefix}_{name}").restype = ctypes.c_double if name == "residual" else ctypes.c_int

    def call(self, name, *arguments):
        return getattr(self.library, f"{self.prefix}_{name}")(doubles(self.model), *arguments)

    def setup(self, parameters, dt):
        given = None if parameters is None else doubles(np.ascontiguousarray(parameters, dtype=np.float64))
        return self.call("setup", given, ctypes.c_double(dt))

    def run(self, excitation: Excitation, parameters=None):
        """Return the outputs at every step, `shape (n_steps + 1, n_outputs)`."""
        assert self.setup(parameters, excitation.dt) == 0
        self.call("reset")
        drives = np.hstack([excitation.inputs, excitation.rates, excitation.forces])
        assert drives.shape[1] == self.count("N_DRIVES")
        found = np.zeros((len(drives), self.count("N_OUTPUTS")))
        for n, now in enumerate(drives):
            if n:
                self.call("step", doubles(0.5 * (drives[n - 1] + now)))
            self.call("outputs", doubles(np.ascontiguousarray(now)), doubles(found[n]))
        return found


def hump(model, duration=1.5, height=0.03, dt=1e-3, speed=3.0):
    """Return a half-sine hump under every axle, something of all other inputs, and a force on every place."""
    time = np.arange(round(duration / dt) + 1) * dt
    s = time[:, None] * speed - model.wheel_offsets() - 0.1
    inside = (s > 0) & (s < 0.5)
    inputs, rates = np.zeros((len(time), len(model.inputs))), np.zeros((len(time), len(model.inputs)))
    width = s.shape[1]
    inputs[:, :width] = np.where(inside, height * np.sin(np.pi * s / 0.5), 0.0)
    rates[:, :width] = np.where(inside, speed * height * np.pi / 0.5 * np.cos(np.pi * s / 0.5), 0.0)
    each = 0.01 * np.arange(1, len(model.inputs) - width + 1)
    inputs[:, width:], rates[:, width:] = each * np.sin(9 * time)[:, None], 9 * each * np.cos(9 * time)[:, None]
    return Excitation(dt, inputs, rates, np.repeat(300 * np.sin(7 * time)[:, None], len(model.forces), axis=1))


def kernel_run(model, excitation, values=None):
    """Return what the kernel computes, at every step."""
    parameters = np.array([list((values or model.values()).values())])
    result = Kernel(model).run(parameters, excitation, 1, np.zeros((1, 2 * model.n_dof)))  # from a state: the form that C has, too
    assert not result.failures
    return result.responses[0]


def assert_alike(found, expected, tolerance=1e-12):
    """Check that columns agree, relative to the largest of each."""
    scale = np.abs(expected).max(axis=0)
    assert (scale > 0).any()
    worst = np.abs(found - expected).max(axis=0)
    assert (worst <= tolerance * scale).all(), worst / np.where(scale, scale, 1)
