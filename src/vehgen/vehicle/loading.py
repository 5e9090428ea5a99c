"""From a file (or a bundled model's name), or whatever an argument may be, to a checked Vehicle."""

from __future__ import annotations

import os
from collections.abc import Iterable
from importlib import resources
from pathlib import Path

from vehgen.errors import ArgumentError, InputError, Position, did_you_mean, shown, trail_text
from vehgen.files.document import Located, read_document, read_text
from vehgen.files.entry import NO_MAPPING
from vehgen.files.names import as_name
from vehgen.files.reading import near_file, short_path
from vehgen.vehicle.changes import merge
from vehgen.vehicle.model import Vehicle

MAX_EXTENDS = 20
VehicleLike = Vehicle | str | os.PathLike[str]
"""A vehicle, its file, or the name of a bundled model."""
NOT_INHERITED = ("name", "description", "source")
"""Said of one file: what extends it is another vehicle, from elsewhere."""


def models_folder() -> Path:
    """Return the folder of the bundled models: inside the installed package, or beside its source."""
    installed = Path(str(resources.files("vehgen"))) / "models"
    return installed if installed.is_dir() else Path(__file__).parents[3] / "models"


def bundled_models() -> dict[str, Path]:
    """Return the bundled models' files by name."""
    return {path.stem: path for path in sorted(models_folder().glob("*.yaml"))}


def is_bundled(path: Path) -> bool:
    """Whether a file is a bundled model's."""
    return path.resolve().parent == models_folder().resolve()


def files_by_name(paths: Iterable[Path], folder: Path) -> dict[str, Path]:
    """Return files by what a file in `folder` would call them, so that two of one name in different folders stay two.

    That is their path from there with slashes; of a bundled model the name of its file, which says nothing of where vehgen is installed.
    """
    found: dict[str, Path] = {}
    for path in sorted(paths, key=is_bundled):  # bundled models last: they leave a name that is taken
        if is_bundled(path):
            name = f"{path.name} (bundled)" if found.get(path.name, path) != path else path.name
        else:
            name = Path(os.path.relpath(path, folder)).as_posix()
        found.setdefault(name, path)
    return found


def vehicle_files(vehicle: Vehicle) -> dict[str, Path]:
    """Return the files that a vehicle was read from, by what its own file calls them."""
    return files_by_name(vehicle.files, vehicle.files[0].parent) if vehicle.files else {}


def find_vehicle_file(name: str | Path, beside: Path | None = None) -> Path:
    """Find a vehicle file: as a path (from `beside` or the working folder), else as a bundled model with or without `.yaml`.

    Raises
    ------
    InputError
        When there is none, with the nearest file beside it or the nearest bundled names.
    """
    path = Path(name)
    local = path if path.is_absolute() or beside is None else beside / path
    try:
        if local.exists():
            return local
    except OSError as error:
        raise InputError(f"cannot read {short_path(local)}: {error.strerror}") from error
    try:
        return _find_bundled(path)
    except InputError as error:
        hint = near_file(local) if local.suffix else ""
        raise InputError(f"no file {short_path(local)}{hint or f', and {error.message}'}") from error


def _find_bundled(name: str | Path) -> Path:
    path, bundled = Path(name), bundled_models()
    if path.parent == Path() and path.stem in bundled and path.suffix in ("", ".yaml"):
        return bundled[path.stem]
    if path.stem in bundled and path.suffix in ("", ".yaml"):
        raise InputError(f"a bundled model is named without a folder: {path.stem}")
    raise InputError(f"no bundled model {shown(path.stem)}; {did_you_mean(path.stem, bundled)}")


def load_vehicle(name: str | Path, beside: Path | None = None) -> Vehicle:
    """Read, merge with what it extends, and check a vehicle file.

    Parameters
    ----------
    name
        A path, or the name of a bundled model.
    beside
        The folder that a relative path starts from (default: the working folder).

    Raises
    ------
    InputError
        With file, line and column, what is wrong and what would be right.
    """
    if not isinstance(name, str | os.PathLike):
        raise ArgumentError(f"`name`: a file or the name of a bundled model was expected, found {type(name).__name__}", "name")
    path = find_vehicle_file(name, beside)
    document, files = _read_extended(path, ())
    return Vehicle.from_document(document, files, as_name(path.stem))


def parse_vehicle(text: str, name: str = "<text>") -> Vehicle:
    """Read a vehicle from YAML text; as :func:`load_vehicle`. `extends` may name bundled models only."""
    document, files = _extend(read_text(text, name), None, ())
    return Vehicle.from_document(document, files, "vehicle")


def _read_extended(path: Path, seen: tuple[Path, ...], at: Position | None = None) -> tuple[Located, tuple[Path, ...]]:
    resolved = path.resolve()
    if resolved in seen:
        chain = trail_text([item.name for item in (*seen[seen.index(resolved) :], resolved)])
        raise InputError(f"circular `extends`: {chain}", at)
    if len(seen) >= MAX_EXTENDS:
        raise InputError(f"more than {MAX_EXTENDS} files extend one another", at)
    try:
        document = read_document(path)
    except InputError as error:
        raise InputError(error.message, error.position or at) from error
    return _extend(document, path, (*seen, resolved))


def _extend(document: Located, path: Path | None, seen: tuple[Path, ...]) -> tuple[Located, tuple[Path, ...]]:
    if not isinstance(document.value, dict):
        raise InputError(NO_MAPPING, document.position)
    files = (path,) if path else ()
    base_name = document.value.get("extends")
    if base_name is None:
        return document, files
    if not isinstance(base_name.value, str):
        raise InputError("`extends` names a file", base_name.position)
    try:
        base_path = find_vehicle_file(base_name.value, path.parent) if path else _find_bundled(base_name.value)
    except InputError as error:
        raise InputError(error.message, base_name.position) from error
    base, base_files = _read_extended(base_path, seen, base_name.position)
    own = {key: item for key, item in document.value.items() if key != "extends"}
    merged = merge(base, Located(own, document.position))
    assert isinstance(merged.value, dict)
    kept = {key: item for key, item in merged.value.items() if key in own or key not in NOT_INHERITED}
    return Located(kept, merged.position, merged.key_position), (*files, *base_files)


def as_vehicle(vehicle: VehicleLike) -> Vehicle:
    """Return the vehicle that an argument means.

    Raises
    ------
    InputError
        For a file that cannot be used, and for anything else than a vehicle, a file or a name.
    """
    if isinstance(vehicle, Vehicle):
        return vehicle
    if isinstance(vehicle, str | os.PathLike):
        return load_vehicle(Path(vehicle))
    found = type(vehicle).__name__
    raise ArgumentError(f"`vehicle`: a Vehicle, a file or the name of a bundled model was expected, found {found}", "vehicle")
