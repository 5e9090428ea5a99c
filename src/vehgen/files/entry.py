"""The form of an entry of a file, and its validation: the first fault found stands at its place in the file."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import Any, ClassVar, TypeVar, get_args

from pydantic import BaseModel, ConfigDict, ValidationError
from pydantic_core import ErrorDetails

from vehgen.errors import InputError, did_you_mean, shown
from vehgen.files.document import Located, locate_arguments, read_document

NO_MAPPING = "a file of `key: value` lines was expected"
_OWN_WORDS = ("expression", "joint", "parameter", "axle", "quantity", "name")
"""Types of the errors that vehgen's own validators raise: their messages are whole sentences."""


def called_by_hand_only(method: Callable[..., None]) -> Callable[..., None]:
    """Mark an `__init__` that pydantic leaves out where it makes an entry of a file: the file's reader does the same with places."""
    vars(method)["__pydantic_base_init__"] = True
    return method


class FileModel(BaseModel):
    """What the entries of all files share: unknown keys are refused, values do not change.

    Made in Python, an entry takes what a file says as keyword arguments: texts such as `8 t`, numbers, expressions, other entries.
    It raises InputError, with the path of the argument, where a file would be refused.

    Attributes
    ----------
    other_keys
        Keys that stand beside the fields in a file and are dealt with before it is validated.
    gathered
        Fields that are gathered from other keys, so that no file names them.
    """

    model_config = ConfigDict(extra="forbid", frozen=True)
    other_keys: ClassVar[tuple[str, ...]] = ()
    gathered: ClassVar[tuple[str, ...]] = ()

    @called_by_hand_only
    def __init__(self, /, **data: Any) -> None:
        try:
            super().__init__(**data)
        except ValidationError as error:
            raise _first_fault(error, type(self), locate_arguments(data, type(self).__name__)) from error


Model = TypeVar("Model", bound=FileModel)


def file_form(entry: Any) -> Any:
    """Return an entry as mappings and lists in the form of its file; expressions, numbers and texts in it stay as they are."""
    if isinstance(entry, FileModel):
        fields = type(entry).model_fields
        given = {name: file_form(getattr(entry, name)) for name in fields if name in entry.model_fields_set}
        spread = {key: item for name in entry.gathered for key, item in given.pop(name, {}).items()}
        return {fields[name].alias or name: item for name, item in given.items() if item is not None} | spread
    if isinstance(entry, Mapping):
        return {key: file_form(item) for key, item in entry.items()}
    return [file_form(item) for item in entry] if isinstance(entry, list | tuple) else entry


def read_entries(model: type[Model], path: str | Path) -> tuple[Model, Located]:
    """Read and validate a YAML file.

    Returns
    -------
    The validated model, and the document with the places of its values.

    Raises
    ------
    InputError
        As :func:`vehgen.files.document.read_document` and :func:`validate`.
    """
    document = read_document(Path(path))
    return validate(model, document.plain(), document), document


def validate(model: type[Model], data: Any, document: Located) -> Model:
    """Build a pydantic model from plain data; the first error becomes an InputError at its place in the document."""
    try:
        return model.model_validate(data)
    except ValidationError as error:
        raise _first_fault(error, model, document) from error


_TOLD_BY = {"bodies": "vehicle", "vehicle": "run"}
"""Keys that tell files of a kind, and the kind."""


def _first_fault(error: ValidationError, model: type[FileModel], document: Located) -> InputError:
    """Return the first error of a validation, unknown keys and faulty names before all others, at its place."""
    errors = error.errors()
    names = (item for item in errors if item["type"] == "extra_forbidden" or "[key]" in item["loc"][-1:])
    first = next(names, errors[0])
    if not first["loc"]:
        return InputError(NO_MAPPING if first["type"] == "model_type" else first["msg"], document.position)
    if isinstance(first["input"], dict) and first["type"] in ("quantity", "string_type"):  # the entry is one of two kinds: not this one
        beside = first["loc"][:-1]
        first = next((item for item in errors if item["loc"][: len(beside)] == beside and item["type"] != first["type"]), first)
    path = (*_in_file(first["loc"][:-1], document), first["loc"][-1])
    if first["type"] == "extra_forbidden":
        key = str(path[-1])
        known = sorted({*_fields_beside(model, first["loc"]), *(model.other_keys if len(path) == 1 else ())})
        around = document.at(path[:-1])
        is_bare = document.at(path).is_bare and all(item.key_position != around.position for item in around.value.values())
        hint = "; quote a text that has a comma within { }" if is_bare else ""  # a mapping in lines begins with its first key
        if is_bare and key[:1].isdigit():
            hint = "; decimals take a point"
        for own, kind in _TOLD_BY.items() if len(path) == 1 else ():
            if own in document.value and own not in known:
                hint = f"; this looks like a {kind} file"
        return InputError(f"unknown key {shown(key)}; {did_you_mean(key, known)}{hint}", document.find(path, key=True))
    if first["type"] in ("missing", "too_long", "tuple_type") and "range" in path[-2:]:
        return InputError("a range has two ends: [low, high]", document.find(path))
    if first["type"] == "missing":
        place = ".".join(str(part) for part in path[:-1]) or ("it" if document.position.is_argument else "the file")
        return InputError(f"{place} lacks the key {str(path[-1])!r}", document.find(path[:-1], key=True))
    if path[-1] == "[key]":
        return InputError(first["msg"], document.find(path[:-1], key=True))
    offset = (first.get("ctx") or {}).get("offset")
    return InputError(_message(first), document.find(path, offset=offset if isinstance(offset, int) else None))


def _message(fault: ErrorDetails) -> str:
    """Return in words what is wrong with a value."""
    message = fault["msg"]
    if fault["type"] in _OWN_WORDS:
        return message
    if fault["type"] in ("model_type", "dict_type"):
        return "expected `key: value` entries"
    if fault["type"] == "string_type" and isinstance(fault["input"], dict | list):
        kind = "`key: value` entries" if isinstance(fault["input"], dict) else "a list"
        return f"expected a single text, found {kind}"
    if fault["type"] in ("tuple_type", "list_type"):
        return f"expected a list: [first, second], or lines that begin with `- ` (found {shown(str(fault['input']))})"
    if fault["type"] == "literal_error":
        return f"{message[0].lower()}{message[1:]}, found {shown(fault['input'])}"
    return f"{message[0].lower()}{message[1:]} (found {shown(str(fault['input']))})"


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


def _fields_beside(model: type[FileModel], path: tuple[int | str, ...]) -> Iterator[str]:
    """Yield the keys allowed where the unknown key at pydantic's `path` stands."""
    current: Any = model
    for part in path[:-1]:
        if _is_model(current):
            current = next((field.annotation for name, field in current.model_fields.items() if part in (name, field.alias)), None)
        else:  # dict[str, X], list[X], or a union whose chosen member `part` names
            members = get_args(current) or (None,)
            current = next((item for item in members if _is_model(item) and item.__name__ in str(part)), members[-1])
        if len(get_args(current)) == 2 and type(None) in get_args(current):
            current = get_args(current)[0]
    if _is_model(current):
        yield from (field.alias or name for name, field in current.model_fields.items() if name not in current.gathered)


def _is_model(item: Any) -> bool:
    return isinstance(item, type) and issubclass(item, FileModel)
