"""The JSON Schema of an entry of `laws`, for editors: the names of the library with their parameters, and an own law."""

from __future__ import annotations

from typing import Any

from vehgen.files.schema import choice
from vehgen.mechanics.laws import LAWS
from vehgen.mechanics.laws.base import Law, LawParameter

_EXPRESSION = {"type": ["string", "number"]}
_FROM = {**choice(("static", "unloaded")), "description": "where its travel counts from: static equilibrium, or where it carries nothing"}


def law_schema() -> dict[str, Any]:
    """Return the schema of one entry of `laws`, `{name: {parameter: value}}`."""
    return {
        "type": "object",
        "additionalProperties": False,
        "description": "a force law in parallel with k and c: {name: {parameter: value}}",
        "properties": {name: _parameters_of(law) for name, law in LAWS.items()} | {"law": _own_law()},
    }


def _parameters_of(law: Law) -> dict[str, Any]:
    return {
        "type": "object",
        "additionalProperties": False,
        "description": f"{law.meaning}; {law.equation}; on a {' or '.join(law.attaches_to)}",
        "properties": {parameter.name: _parameter(parameter) for parameter in law.parameters} | {"from": _FROM},
        "required": [parameter.name for parameter in law.parameters if parameter.default is None],
    }


def _parameter(parameter: LawParameter) -> dict[str, Any]:
    default = {} if parameter.default is None else {"default": parameter.default}
    return {**_EXPRESSION, "description": parameter.meaning, **default}


def _own_law() -> dict[str, Any]:
    return {
        "type": "object",
        "additionalProperties": False,
        "description": "a law of your own",
        "properties": {
            "force": {**_EXPRESSION, "description": "an expression of travel d, rate v and its parameters"},
            "parameters": {"type": "object", "additionalProperties": _EXPRESSION},
            "from": _FROM,
        },
        "required": ["force"],
    }
