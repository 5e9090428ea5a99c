"""The JSON Schema of the vehicle file, for editors that complete and check it."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from vehgen.files.schema import editor_schema
from vehgen.vehicle.loading import bundled_models
from vehgen.vehicle.model import Vehicle


def vehicle_schema(laws: Mapping[str, Any] | None = None) -> dict[str, Any]:
    """Return the schema; nothing is required at the top, because a file that extends another may leave anything out.

    Parameters
    ----------
    laws
        The schema of one entry of `laws` (default: any law with any parameters).
    """
    schema = editor_schema(Vehicle, "vehgen vehicle file")
    schema["properties"] = {
        "extends": {"type": "string", "description": "a file or bundled model to start from", "examples": list(bundled_models())},
        **schema["properties"],
    }
    schema.pop("required", None)
    definitions = schema["$defs"]
    for name in ("Body", "Axle"):
        definitions[name].pop("required", None)
    for name in ("Hinge", "Link"):
        joint = definitions[name]
        joint["additionalProperties"] = joint["properties"].pop("points")["additionalProperties"]
    if laws is not None:
        definitions["Law"] = dict(laws)
        for name in ("Spring", "Hinge", "Link"):
            definitions[name]["properties"]["laws"]["items"] = {"$ref": "#/$defs/Law"}
    return schema
