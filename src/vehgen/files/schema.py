"""JSON Schemas of files, for editors that complete and check them."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from pydantic.json_schema import GenerateJsonSchema, JsonSchemaValue
from pydantic_core import core_schema

from vehgen.files.entry import FileModel
from vehgen.files.expressions import Expression

DIALECT = "https://json-schema.org/draft/2020-12/schema"


class EditorSchema(GenerateJsonSchema):
    """A schema that shows what a file would say: defaults as they are written, none where a key is simply left out, no made-up titles."""

    def default_schema(self, schema: core_schema.WithDefaultSchema) -> JsonSchemaValue:
        """Leave out the defaults of keys that nobody writes: nothing, and the empty text."""
        made = super().default_schema(schema)
        if "default" in made and made["default"] in (None, ""):
            del made["default"]
        return made

    def encode_default(self, dft: Any) -> Any:
        """Write an expression as its text."""
        return dft.text if isinstance(dft, Expression) else super().encode_default(dft)

    def field_title_should_be_set(self, schema: Any) -> bool:
        """A key is called what the file calls it."""
        return False


def editor_schema(model: type[FileModel], title: str) -> dict[str, Any]:
    """Return the JSON Schema of a file.

    Parameters
    ----------
    model
        The form of the file.
    title
        What the file is called.
    """
    schema = {"$schema": DIALECT, **model.model_json_schema(schema_generator=EditorSchema), "title": title}
    for definition in schema.get("$defs", {}).values():
        definition.pop("title", None)
    return schema


def choice(values: Iterable[str]) -> dict[str, Any]:
    """Return the schema of a text that is one of several."""
    return {"type": "string", "enum": list(values)}
