"""From a file (or a bundled model's name) to a checked Vehicle."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from importlib import resources
from pathlib import Path
from typing import Any, TypeVar, get_args

from pydantic import BaseModel, ValidationError

from vehgen.errors import InputError, Position, did_you_mean, shortened, shown, trail_text
from vehgen.files.document import Located, read_document, read_text
from vehgen.files.names import as_name
from vehgen.files.reading import short_path
from vehgen.vehicle.checks import check_vehicle
from vehgen.vehicle.model import Joint, Vehicle

Model = TypeVar("Model", bound=BaseModel)
MAX_EXTENDS = 20


def models_folder() -> Path:
    """Return the folder of the bundled models: inside the installed package, or beside its source."""
    installed = Path(str(resources.files("vehgen"))) / "models"
    return installed if installed.is_dir() else Path(__file__).parents[3] / "models"


def bundled_models() -> dict[str, Path]:
    """Return the bundled models' files by name."""
    return {path.stem: path for path in sorted(models_folder().glob("*.yaml"))}


def find_vehicle_file(name: str | Path, beside: Path | None = None) -> Path:
    """Find a vehicle file: as a path (from `beside` or the working folder), else as a bundled model with or without `.yaml`.

    Raises
    ------
    InputError
        When there is none, with the nearest bundled names.

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
        raise InputError(f"no file {short_path(local)}, and {error.message}") from error


def _find_bundled(name: str | Path) -> Path:
    path, bundled = Path(name), bundled_models()
    if path.parent == Path() and path.stem in bundled and path.suffix in ("", ".yaml"):
        return bundled[path.stem]
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
    path = find_vehicle_file(name, beside)
    document, files = _read_extended(path, ())
    return _finish(document, files, as_name(path.stem))


def parse_vehicle(text: str, name: str = "<text>") -> Vehicle:
    """Read a vehicle from YAML text; as :func:`load_vehicle`. `extends` may name bundled models only."""
    document, files = _extend(read_text(text, name), None, ())
    return _finish(document, files, "vehicle")


def extend_vehicle(vehicle: Vehicle, change: Mapping[str, Any], name: str = "<change>") -> Vehicle:
    """Return a vehicle with a change laid over it, as a file that extends it would say it.

    Parameters
    ----------
    vehicle
        A vehicle read from a file or text.
    change
        Plain mappings, lists, texts and numbers in the form of a vehicle file; None removes a key.

    Raises
    ------
    InputError
        For a change that does not fit.
    """
    assert vehicle._document is not None
    merged = merge(vehicle._document, read_text(json.dumps(change), name))
    return _finish(merged, vehicle.files, vehicle.name)


def _finish(document: Located, files: tuple[Path, ...], default_name: str) -> Vehicle:
    data = document.plain()
    data.setdefault("name", default_name)
    vehicle = validate(Vehicle, data, document)
    vehicle._document = document
    vehicle._files = files
    check_vehicle(vehicle)
    return vehicle


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
        raise InputError("a file of `key: value` lines was expected", document.position)
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
    return merged, (*files, *base_files)


def merge(base: Located, change: Located) -> Located:
    """Lay `change` over `base`: mappings merge key by key, null removes, everything else replaces."""
    if not (isinstance(base.value, dict) and isinstance(change.value, dict)):
        return change
    kept = dict(base.value)
    for clash, other in (("equals", ("value", "range")), ("value", ("equals",))):
        if clash in change.value and not isinstance(change.value[clash].value, dict):
            kept = {key: item for key, item in kept.items() if key not in other}
    for key, item in change.value.items():
        if item.value is None:
            if key not in kept:
                raise InputError(
                    f"null removes {shown(key)}, but the file it extends has none; {did_you_mean(key, kept)}",
                    item.key_position,
                )
            del kept[key]
        else:
            kept[key] = merge(kept[key], item) if key in kept else item
    return Located(kept, change.position, change.key_position)


def validate(model: type[Model], data: Any, document: Located) -> Model:
    """Build a pydantic model from plain data; the first error becomes an InputError at its place in the file."""
    try:
        return model.model_validate(data)
    except ValidationError as error:
        raise _translate(error, model, document) from error


def _translate(error: ValidationError, model: type[BaseModel], document: Located) -> InputError:
    errors = error.errors()
    names = (item for item in errors if item["type"] == "extra_forbidden" or item["loc"][-1] == "[key]")
    first = next(names, errors[0])
    if isinstance(first["input"], dict) and first["type"] in ("quantity", "string_type"):  # the entry is one of two kinds: not this one
        beside = first["loc"][:-1]
        first = next((item for item in errors if item["loc"][: len(beside)] == beside and item["type"] != first["type"]), first)
    path = (*_in_file(first["loc"][:-1], document), first["loc"][-1])
    if first["type"] == "extra_forbidden":
        key = str(path[-1])
        known = sorted({*_fields_beside(model, first["loc"]), *(["extends"] if model is Vehicle and len(path) == 1 else [])})
        return InputError(f"unknown key {shown(key)}; {did_you_mean(key, known)}", document.find(path, key=True))
    if first["type"] in ("missing", "too_long", "tuple_type") and "range" in path[-2:]:
        return InputError("a range has two ends: [low, high]", document.find(path))
    if first["type"] == "missing":
        place = ".".join(str(part) for part in path[:-1]) or "the file"
        return InputError(f"{shortened(place)} lacks the key {shown(path[-1])}", document.find(path[:-1], key=True))
    if path[-1] == "[key]":
        return InputError(first["msg"], document.find(path[:-1], key=True))
    offset = (first.get("ctx") or {}).get("offset")
    position = document.find(path, offset=offset if isinstance(offset, int) else None)
    message = first["msg"]
    if first["type"] in ("model_type", "dict_type"):
        message = "expected `key: value` entries"
    elif first["type"] in ("tuple_type", "list_type"):
        message = f"expected a list: [first, second], or lines that begin with `- ` (found {shown(str(first['input']))})"
    elif first["type"] == "literal_error":
        message = f"{message[0].lower()}{message[1:]}, found {shown(first['input'])}"
    elif first["type"] not in ("expression", "joint", "parameter", "axle", "quantity", "name"):
        message = f"{message[0].lower()}{message[1:]} (found {shown(str(first['input']))})"
    return InputError(message, position)


def _in_file(path: tuple[int | str, ...], document: Located) -> tuple[int | str, ...]:
    """Leave out what pydantic adds to a path: the names of fields and of kinds that the file does not show."""
    node = document
    kept: list[int | str] = []
    for part in path:
        child = node.child(part)
        if child is not None:
            node = child
            kept.append(part)
    return tuple(kept)


def _fields_beside(model: type[BaseModel], path: tuple[int | str, ...]) -> Iterator[str]:
    """Yield the keys allowed where the unknown key at pydantic's `path` stands."""
    current: Any = model
    for part in path[:-1]:
        if _is_model(current):
            current = next((field.annotation for name, field in current.model_fields.items() if part in (name, field.alias)), None)
        else:  # dict[str, X], list[X], or a union whose chosen member `part` names
            current = get_args(current)[-1] if get_args(current) else None
        if type(None) in get_args(current):
            current = get_args(current)[0]
    if _is_model(current):
        for name, field in current.model_fields.items():
            if not (issubclass(current, Joint) and name == "points"):
                yield field.alias or name


def _is_model(item: Any) -> bool:
    return isinstance(item, type) and issubclass(item, BaseModel)
