"""Co-simulation units (FMI 2.0 and 3.0) made of the exported C: description, sources, and a binary where a C compiler is at hand."""

from __future__ import annotations

import hashlib
import io
import platform
import shutil
import subprocess
import tempfile
import warnings
import zipfile
from collections.abc import Mapping
from pathlib import Path
from typing import Literal

from vehgen.codegen.printing import literal
from vehgen.errors import ModelWarning, shortened
from vehgen.export.c_files import c_texts, from_template
from vehgen.export.c_program import c_program
from vehgen.export.fmu_description import describe_build, describe_fmi2, describe_fmi3
from vehgen.export.fmu_variables import fmu_variables
from vehgen.export.identifiers import identifier
from vehgen.export.source import ExportSource

FmiVersion = Literal[2, 3]
GLUE: dict[FmiVersion, tuple[str, ...]] = {2: ("fmi2.c",), 3: ("fmi3.c", "fmi3_refused.c", "fmi3_types.h")}
"""Sources that a version of the standard asks for."""
C_COMPILERS = ("gcc", "cc", "clang")
BUILD_OPTIONS = ("-std=c99", "-O2", "-fPIC", "-shared", "-fvisibility=hidden")
BINARY_FOLDERS: dict[FmiVersion, dict[str, str]] = {
    2: {"x86_64 Linux": "linux64"},
    3: {"x86_64 Linux": "x86_64-linux", "aarch64 Linux": "aarch64-linux"},
}
"""What the standard calls the binaries of a machine and its system."""
BUILD_SECONDS = 300.0
"""A compiler that takes longer is stopped [s]."""
PREFIX = "model"
"""What the names of the vehicle's C code begin with inside a unit."""


def write_fmu2(source: ExportSource) -> dict[str, bytes]:
    """Return a unit of FMI 2.0."""
    return _unit(source, 2)


def write_fmu3(source: ExportSource) -> dict[str, bytes]:
    """Return a unit of FMI 3.0."""
    return _unit(source, 3)


def _unit(source: ExportSource, version: FmiVersion) -> dict[str, bytes]:
    name, program = identifier(source.stem), c_program(source)
    variables, texts = fmu_variables(source, program), c_texts(source, program, PREFIX)
    for file in ("instance.h", "instance.c", *GLUE[version]):
        texts[file] = from_template(file, PREFIX, DT=literal(source.step))
    compiled = [file for file in texts if file.endswith(".c")]

    def describe(token: str) -> bytes:
        if version == 2:
            return describe_fmi2(source, variables, name, token, compiled)
        return describe_fmi3(source, variables, name, token)

    token = _token([describe("").decode(), *texts.values()])
    texts["token.h"] = f'#define FMU_TOKEN "{token}"\n'
    files = {"modelDescription.xml": describe(token), **{f"sources/{file}": text.encode() for file, text in texts.items()}}
    if version == 3:
        files["sources/buildDescription.xml"] = describe_build(name, compiled)
    folder = BINARY_FOLDERS[version].get(f"{platform.machine()} {platform.system()}")
    if folder is None:
        _warn("binaries are built on Linux alone")
    elif (binary := _binary(texts, compiled)) is not None:
        files[f"binaries/{folder}/{name}.so"] = binary
    return {f"{source.stem}.fmu": _archive(files)}


def _token(texts: list[str]) -> str:
    """Return an identifier of a unit's content, in the form of a GUID."""
    digits = hashlib.sha256("\0".join(texts).encode()).hexdigest()
    return "{" + "-".join((digits[:8], digits[8:12], digits[12:16], digits[16:20], digits[20:32])) + "}"


def _archive(files: Mapping[str, bytes]) -> bytes:
    """Return a zip archive; equal files give equal bytes."""
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, data in files.items():
            entry = zipfile.ZipInfo(name)
            entry.compress_type, entry.external_attr = zipfile.ZIP_DEFLATED, 0o644 << 16
            archive.writestr(entry, data)
    return stream.getvalue()


def _binary(texts: Mapping[str, str], compiled: list[str]) -> bytes | None:
    """Return the shared library of a unit; None, with a warning, where no compiler makes one."""
    compiler = next((path for name in C_COMPILERS if (path := shutil.which(name)) is not None), None)
    if compiler is None:
        _warn("no C compiler is installed")
        return None
    with tempfile.TemporaryDirectory(prefix="vehgen_fmu_") as place:
        folder = Path(place)
        for file, text in texts.items():
            (folder / file).write_text(text, encoding="utf-8")
        command = [compiler, *BUILD_OPTIONS, "-o", "unit.so", *compiled, "-lm"]
        try:
            done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False, timeout=BUILD_SECONDS)
            said = done.stderr.strip() if done.returncode else ""
        except (OSError, subprocess.TimeoutExpired) as error:
            said = str(error)
        if not (folder / "unit.so").is_file():
            _warn(f"{compiler} could not build it ({shortened(said, 200)})")
            return None
        return (folder / "unit.so").read_bytes()


def _warn(reason: str) -> None:
    warnings.warn(ModelWarning(f"the unit holds its sources, but no binary: {reason}"), stacklevel=2)
