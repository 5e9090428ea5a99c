"""The JSON Schema of the run file, for editors that complete and check it."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from vehgen.files.schema import choice, editor_schema
from vehgen.measure.acquisition import FILTER_KINDS
from vehgen.measure.recorders import RECORDERS
from vehgen.mechanics.quantities import ELEMENT_QUANTITIES, QUANTITIES
from vehgen.simulate.run_file.acquisition import WITHOUT_CUT_OFF
from vehgen.simulate.run_file.entries import RunFile
from vehgen.vehicle import bundled_models


def run_schema() -> dict[str, Any]:
    """Return the schema; quantities, filters and recorders are enumerated."""
    schema = editor_schema(RunFile, "vehgen run file")
    definitions = schema["$defs"]
    schema["properties"]["vehicle"]["examples"] = list(bundled_models())
    del schema["properties"]["speed"]["default"]  # it stands for rigs, on which no speed acts: a vehicle with wheels has none
    definitions["OutputEntry"]["properties"]["quantity"] = {**choice(ELEMENT_QUANTITIES), "description": _listed(ELEMENT_QUANTITIES)}
    definitions["AcquisitionEntry"]["properties"]["filter"] = choice(FILTER_KINDS)
    for holder in (schema, definitions["SensorEntry"], definitions["ChannelEntry"]):
        _name_recorders(holder["properties"]["acquisition"])
    channels = definitions["SensorEntry"]["properties"]["channels"]
    entry = channels.pop("additionalProperties")
    channels.pop("propertyNames", None)
    channels["properties"] = {
        name: {**entry, "description": f"in {unit}, where `unit` says nothing else"} for name, unit in QUANTITIES.items()
    }
    channels["additionalProperties"] = False
    return schema


def _name_recorders(acquisition: dict[str, Any]) -> None:
    """Enumerate what may stand in place of a recorder's numbers."""
    kinds = acquisition["anyOf"]
    kinds[kinds.index({"type": "string"})] = {
        **choice((*WITHOUT_CUT_OFF, *RECORDERS)),
        "description": "; ".join(f"{name}: {recorder.title}" for name, recorder in RECORDERS.items()),
    }


def _listed(quantities: Mapping[str, str]) -> str:
    return ", ".join(f"{name} [{unit}]" for name, unit in quantities.items())
