"""Generated kernels become modules, plain loops functions: compiled once, then loaded from the cache by every later process.

numba keeps compiled code only for functions that live in a file, so a kernel's source is written to a temporary folder together with what
the cache holds of it, imported from there, and what numba wrote anew is kept. The cache is `$VEHGEN_CACHE`, else the user's cache folder.
"""

from __future__ import annotations

import hashlib
import importlib.util
import inspect
import os
import sys
import tempfile
import threading
import warnings
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import cache
from importlib import metadata
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np

from vehgen.codegen.cache_pruning import prune
from vehgen.codegen.kernel_store import PARTS, private_folder, read_parts, refuse_open_folder, writable_folder, write_parts
from vehgen.errors import CacheWarning, InputError

_LOOPS_HEAD = '''"""{name} of {module}, compiled; written by vehgen.codegen.cache."""

from __future__ import annotations

import numba
import numpy as np
{imports}

@numba.njit("{signature}", nogil=True, cache=True, fastmath={{"contract", "nsz"}}, error_model="numpy")
'''


def cache_folder() -> Path:
    """Return the folder of generated kernels (it need not exist yet)."""
    if chosen := os.environ.get("VEHGEN_CACHE"):
        return Path(chosen)
    try:
        if sys.platform == "win32":
            base = Path(os.environ.get("LOCALAPPDATA") or Path.home() / "AppData" / "Local")
        elif sys.platform == "darwin":
            base = Path.home() / "Library" / "Caches"
        else:
            base = Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache")
    except RuntimeError:  # this user has no home
        return private_folder()
    return base / "vehgen"


_WRITER = "".join((Path(__file__).parent / name).read_text(encoding="utf-8") for name in ("emit_llvm.py", "llvm_text.py"))
"""What turns a kernel's text into instructions: numba does not see when it changes."""


_SOURCE_TIME = 1_000_000_000
"""Time of change of every kernel's source [s]: byte code, and numba's index before version 0.62, hold for this time only."""
_importing = threading.Lock()


@cache
def _versions() -> str:
    return f"{metadata.version('numba')} {metadata.version('llvmlite')} {np.__version__} {sys.implementation.cache_tag}"


def kernel_name(text: str) -> str:
    """Return the module name of a kernel: the hash of its source, of what writes its instructions, and of the versions that compile it."""
    digest = hashlib.sha256(f"{_versions()}\n{_WRITER}\n{text}".encode()).hexdigest()
    return f"kernel_{digest[:20]}"


def is_compiled(text: str, folder: Path) -> bool:
    """Whether this process has loaded a kernel, or the folder holds its compiled code, or none is wanted (NUMBA_DISABLE_JIT)."""
    name = kernel_name(text)
    return bool(f"vehgen_{name}" in sys.modules or read_parts(folder, name) or not _compiles())


def import_kernel(text: str, folder: Path | None = None) -> ModuleType:
    """Import a kernel's source; importing compiles it or loads what the cache holds.

    Parameters
    ----------
    text
        The source of :func:`vehgen.codegen.kernel_source.write_kernel`.
    folder
        Where compiled code is kept (default: the user's cache folder). One that cannot be trusted, read or written costs time only.
    """
    name = kernel_name(text)
    folder = folder or cache_folder()
    with _importing:
        if f"vehgen_{name}" in sys.modules:
            return sys.modules[f"vehgen_{name}"]
        if not _compiles():
            _warn_of_plain_python()
        known = read_parts(folder, name)
        try:
            module, parts = _import_in(None, text, name, known)
        except OSError:  # the folder of temporary files is full, or open to everybody
            module, parts = _import_in(writable_folder(folder), text, name, known)
        if parts != known and _compiles():
            write_parts(folder, name, parts)
            prune(writable_folder(folder))
        return module


def _compiles() -> bool:
    from vehgen.codegen.emit_llvm import compiles

    return compiles()


@cache
def _warn_of_plain_python() -> None:
    message = "NUMBA_DISABLE_JIT is set: kernels run in plain Python, some hundred times slower; unset it to compile them"
    warnings.warn(CacheWarning(message), stacklevel=3)


def _import_in(place: Path | None, text: str, name: str, known: dict[str, bytes]) -> tuple[ModuleType, dict[str, bytes]]:
    """Import a kernel from a temporary folder within `place`; return it with the files that hold its compiled code."""
    with tempfile.TemporaryDirectory(prefix="vehgen_", dir=place, ignore_cleanup_errors=True) as path:
        stage = Path(path)
        refuse_open_folder(stage)
        compiled = stage / "__pycache__"
        compiled.mkdir()
        for item, content in known.items():
            (compiled / item).write_bytes(content)
        module = _execute(text, name, stage)
        found = [path for path in compiled.iterdir() if path.suffix in PARTS and path.name.startswith(f"{name}.")]
        return module, {path.name: path.read_bytes() for path in found}


def _execute(text: str, name: str, stage: Path) -> ModuleType:
    path = stage / f"{name}.py"
    path.write_text(text, encoding="utf-8")
    os.utime(path, (_SOURCE_TIME, _SOURCE_TIME))
    module_name = f"vehgen_{name}"
    specification = importlib.util.spec_from_file_location(module_name, path)
    if specification is None or specification.loader is None:
        raise InputError(f"cannot import the generated kernel {path}")
    module = importlib.util.module_from_spec(specification)
    sys.modules[module_name] = module  # numba looks the module up while it compiles
    try:
        with _numba_beside_the_source():
            specification.loader.exec_module(module)
    except BaseException:
        del sys.modules[module_name]
        raise
    return module


@contextmanager
def _numba_beside_the_source() -> Iterator[None]:
    """Let numba look for compiled code beside the source only, wherever NUMBA_CACHE_DIR and the like point to."""
    import numba

    kept = {key: getattr(numba.config, key) for key in ("CACHE_DIR", "CACHE_LOCATOR_CLASSES") if hasattr(numba.config, key)}
    for key in kept:
        setattr(numba.config, key, "")
    try:
        yield
    finally:
        for key, value in kept.items():
            setattr(numba.config, key, value)


@cache
def compile_loops(function: Callable[..., Any], signature: str, imports: str = "") -> Callable[..., Any]:
    """Return a function compiled for arguments of one signature.

    Parameters
    ----------
    function
        Of a module's own level: its source is compiled as it stands, so that it may use numpy as `np`, and nothing else of its module.
    signature
        What it takes and returns, in numba's words.
    imports
        A line that imports what else it uses.
    """
    head = _LOOPS_HEAD.format(name=function.__name__, module=function.__module__, signature=signature, imports=imports)
    compiled: Callable[..., Any] = getattr(import_kernel(head + inspect.getsource(function)), function.__name__)
    return compiled
