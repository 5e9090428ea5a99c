"""From a file (or a bundled model's name) to a checked Vehicle."""

from __future__ import annotations

from collections.abc import Iterator
from importlib import resources
from pathlib import Path
from typing import Any, TypeVar

from pydantic import BaseModel, ValidationError

from vehgen.errors import InputError, Position, did_you_mean
from vehgen.vehicle.checks import check_vehicle
from vehgen.vehicle.document import Located, read_document, read_text
from vehgen.vehicle.model import Joint, Vehicle

Model = TypeVar("Model", bound=BaseModel)


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
    if local.exists():
        return local
    bundled = bundled_models()
    if path.parent == Path() and path.stem in bundled and path.suffix in ("", ".yaml"):
        return bundled[path.stem]
    raise InputError(f"no file {local}, and no bundled model {path.stem!r}; {did_you_mean(path.stem, bundled)}")


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
    return _finish(document, files, path.stem)


def parse_vehicle(text: str, name: str = "<text>") -> Vehicle:
    """Read a vehicle from YAML text; as :func:`load_vehicle`. `extends` may name bundled models only."""
    document, files = _extend(read_text(text, name), None, ())
    return _finish(document, files, "vehicle")


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
        chain = " -> ".join(item.name for item in (*seen[seen.index(resolved) :], resolved))
        raise InputError(f"circular `extends`: {chain}", at)
    return _extend(read_document(path), path, (*seen, resolved))


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
        base_path = find_vehicle_file(base_name.value, path.parent if path else Path("/nonexistent"))
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
        if clash in change.value:
            kept = {key: item for key, item in kept.items() if key not in other}
    for key, item in change.value.items():
        if item.value is None:
            if key not in kept:
                raise InputError(
                    f"null removes {key!r}, but the file it extends has none; {did_you_mean(key, kept)}",
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
    first = next((item for item in errors if item["type"] == "extra_forbidden"), errors[0])
    path = tuple(part for part in first["loc"] if part != "points")
    if first["type"] == "extra_forbidden":
        key = str(path[-1])
        known = sorted(set(_fields_beside(model, path)))
        return InputError(f"unknown key {key!r}; {did_you_mean(key, known)}", document.find(path, key=True))
    if first["type"] == "missing":
        place = ".".join(str(part) for part in path[:-1]) or "the file"
        return InputError(f"{place} lacks the key {str(path[-1])!r}", document.find(path[:-1], key=True))
    position = document.find(path)
    offset = (first.get("ctx") or {}).get("offset")
    if isinstance(offset, int):
        position = Position(position.file, position.line, position.column + offset)
    message = first["msg"]
    if first["type"] in ("model_type", "dict_type"):
        message = "expected `key: value` entries"
    elif first["type"] == "literal_error":
        message = f"{message[0].lower()}{message[1:]}, found {first['input']!r}"
    elif first["type"] not in ("expression", "joint", "parameter", "axle", "quantity"):
        message = f"{message[0].lower()}{message[1:]} (found {str(first['input'])[:60]!r})"
    return InputError(message, position)


def _fields_beside(model: type[BaseModel], path: tuple[int | str, ...]) -> Iterator[str]:
    """Yield the keys allowed where the unknown key at `path` stands."""
    current: Any = model
    for part in path[:-1]:
        annotation = current.model_fields[part].annotation if _is_model(current) and part in current.model_fields else current
        current = _inner_model(annotation)
    if _is_model(current):
        yield from (name for name in current.model_fields if not (issubclass(current, Joint) and name == "points"))


def _is_model(item: Any) -> bool:
    return isinstance(item, type) and issubclass(item, BaseModel)


def _inner_model(annotation: Any) -> Any:
    """Return the first pydantic model inside an annotation such as dict[str, Body] or Spring | None."""
    if _is_model(annotation):
        return annotation
    for argument in getattr(annotation, "__args__", ()):
        found = _inner_model(argument)
        if _is_model(found):
            return found
    return annotation
