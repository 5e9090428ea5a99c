"""The JSON Schema of the vehicle file, for editors that complete and check it."""

from __future__ import annotations

from typing import Any

from vehgen.vehicle.model import Vehicle


def vehicle_schema() -> dict[str, Any]:
    """Return the schema; nothing is required at the top, because a file that extends another may leave anything out."""
    schema = Vehicle.model_json_schema()
    schema["$schema"] = "https://json-schema.org/draft/2020-12/schema"
    schema["title"] = "vehgen vehicle file"
    schema["properties"] = {
        "extends": {"type": "string", "description": "a file or bundled model to start from"},
        **schema["properties"],
    }
    schema.pop("required", None)
    for name in ("Body", "Axle"):
        schema["$defs"][name].pop("required", None)
    for name in ("Hinge", "Link"):
        joint = schema["$defs"][name]
        joint["additionalProperties"] = joint["properties"].pop("points")["additionalProperties"]
    return schema
