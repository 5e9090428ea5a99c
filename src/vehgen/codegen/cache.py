"""Kernel files: named by the hash of their source, written whole or not at all, compiled code kept beside them.

numba keeps compiled code only for functions that live in a file, so a kernel is written to a folder and imported from there. The folder
is `$VEHGEN_CACHE`, else the user's cache folder; nothing but vehgen's own generated source is ever imported from it.
"""

from __future__ import annotations

import hashlib
import importlib.util
import os
import sys
import tempfile
from pathlib import Path
from types import ModuleType

import numba

from vehgen.errors import InputError


def cache_folder() -> Path:
    """Return the folder of generated kernels (it need not exist yet)."""
    if chosen := os.environ.get("VEHGEN_CACHE"):
        return Path(chosen)
    if sys.platform == "win32":
        base = Path(os.environ.get("LOCALAPPDATA", Path.home() / "AppData" / "Local"))
    elif sys.platform == "darwin":
        base = Path.home() / "Library" / "Caches"
    else:
        base = Path(os.environ.get("XDG_CACHE_HOME", Path.home() / ".cache"))
    return base / "vehgen"


_WRITER = (Path(__file__).parent / "straight.py").read_text(encoding="utf-8")
"""What turns a kernel's text into instructions: numba does not see when it changes."""


def kernel_name(text: str) -> str:
    """Return the module name of a kernel: the hash of its source, of numba's version and of what writes its instructions."""
    digest = hashlib.sha256(f"{numba.__version__}\n{_WRITER}\n{text}".encode()).hexdigest()
    return f"kernel_{digest[:20]}"


def write_text(path: Path, text: str) -> None:
    """Write a file under a temporary name and rename it, so that no half-written file stays behind.

    Raises
    ------
    InputError
        When the folder cannot be written to.

    """
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        handle, temporary = tempfile.mkstemp(dir=path.parent, prefix=f".{path.name}.")
    except OSError as error:
        raise InputError(f"cannot write {path}: {error.strerror}") from error
    try:
        with os.fdopen(handle, "w", encoding="utf-8") as stream:
            stream.write(text)
        Path(temporary).chmod(0o666 & ~_umask())  # mkstemp keeps a file to its owner
        Path(temporary).replace(path)
    except BaseException:
        Path(temporary).unlink(missing_ok=True)
        raise


def _umask() -> int:
    mask = os.umask(0)
    os.umask(mask)
    return mask


def is_compiled(text: str, folder: Path) -> bool:
    """Whether this process has loaded a kernel, or the folder holds its compiled code."""
    name = kernel_name(text)
    return f"vehgen_{name}" in sys.modules or any((folder / "__pycache__").glob(f"{name}.*.nbi"))


def import_kernel(text: str, folder: Path | None = None) -> ModuleType:
    """Write a kernel's source into the cache (unless it is there) and import it; importing compiles it or loads what was compiled."""
    name = kernel_name(text)
    module_name = f"vehgen_{name}"
    if module_name in sys.modules:
        return sys.modules[module_name]
    path = (folder or cache_folder()) / f"{name}.py"
    if not path.is_file() or path.read_text(encoding="utf-8") != text:
        write_text(path, text)
    specification = importlib.util.spec_from_file_location(module_name, path)
    if specification is None or specification.loader is None:
        raise InputError(f"cannot import the generated kernel {path}")
    module = importlib.util.module_from_spec(specification)
    sys.modules[module_name] = module  # numba looks the module up while it compiles
    try:
        specification.loader.exec_module(module)
    except BaseException:
        del sys.modules[module_name]
        raise
    return module
