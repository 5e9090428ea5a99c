"""A vehicle as C99: one header, one source, and an example that drives it over a hump; nothing but the mathematical library is needed."""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import Path

from vehgen.codegen.printing import literal
from vehgen.export.c_program import CProgram, c_program
from vehgen.export.identifiers import c_text, distinct_identifiers, identifier
from vehgen.export.source import ExportSource
from vehgen.files.provenance import versions

TEMPLATES = Path(__file__).with_name("templates")
MAX_PREFIX = 24
"""Characters of what the names of a vehicle's C code begin with."""
OTHER_HEADERS = frozenset({"float", "limits", "math", "stdio", "stdlib", "string"})
"""Headers that a vehicle's own may not be mistaken for."""


def write_c(source: ExportSource) -> dict[str, bytes]:
    """Return header, source and example, named after the vehicle."""
    prefix = identifier(f"v_{source.stem}" if source.stem in OTHER_HEADERS else source.stem, MAX_PREFIX)
    texts = {
        **c_texts(source, c_program(source), prefix),
        f"{prefix}_main.c": from_template("example_main.c", prefix, DT=literal(source.step)),
    }
    return {name: text.encode() for name, text in texts.items()}


def c_texts(source: ExportSource, program: CProgram, prefix: str) -> dict[str, str]:
    """Return the header and the source whose names begin with a prefix."""
    return {f"{prefix}.h": _header(source, program, prefix), f"{prefix}.c": _source(source, program, prefix)}


def from_template(name: str, prefix: str, **others: str) -> str:
    """Return a file of the folder of templates with the prefix, and other words, in the places of @prefix@, @PREFIX@, @WORD@."""
    words = {"prefix": prefix, "PREFIX": prefix.upper(), **others}
    text = (TEMPLATES / name).read_text(encoding="utf-8")
    return re.sub(r"@(\w+)@", lambda match: words[match[1]], text)  # once: what is put in may hold such a word of its own


def _header(source: ExportSource, program: CProgram, prefix: str) -> str:
    model, big = source.model, prefix.upper()
    counts = {
        "N_DOF": model.n_dof, "N_PARAMETERS": len(model.parameters), "N_INPUTS": len(model.inputs), "N_FORCES": len(model.forces),
        "N_DRIVES": 2 * len(model.inputs) + len(model.forces), "N_OUTPUTS": len(model.channels), "N_STATES": program.n_states,
        "N_AXLES": len(model.vehicle.axles),
    }  # fmt: skip
    numbers = [f"#define {big}_{name} {count}" for name, count in counts.items()]
    names = {
        "parameter": list(model.parameters),
        "drive": [*model.inputs, *(f"{name}.rate" for name in model.inputs), *(f"force.{name}" for name in model.forces)],
        "output": [item.name for item in model.channels],
    }
    places = [line for kind, items in names.items() for line in _enumerators(f"{big}_{kind.upper()}", items)]
    lengths = {"CONSTANTS": program.n_constants, "ALL_PARAMETERS": len(model.parameters) + len(program.static_travels)}
    sizes = [f"#define {big}_{name}_LENGTH {max(count, 1)}" for name, count in lengths.items()]
    return from_template(
        "model.h", prefix, VERSION=versions(())["vehgen"], COUNTS="\n".join(numbers), SIZES="\n".join(sizes), PLACES="\n".join(places)
    )


def _enumerators(prefix: str, names: Sequence[str]) -> list[str]:
    """Return an enumeration of places in an array, one for each name."""
    found = [f"    {name} = {place}" for place, name in enumerate(distinct_identifiers(prefix, names))]
    return ["enum {", ",\n".join(found), "};"] if found else []


def _source(source: ExportSource, program: CProgram, prefix: str) -> str:
    model = source.model
    dimensions = model.vehicle.dimensions
    units = [str(dimensions[name]) if name in dimensions else "m" for name in model.parameters]
    width = len(model.inputs)
    drives = [*model.inputs, *(f"{name}.rate" for name in model.inputs), *(f"force.{name}" for name in model.forces)]
    tables = [
        *_texts(f"{prefix}_parameter_names", model.parameters),
        *_texts(f"{prefix}_parameter_units", units),
        *_numbers(f"{prefix}_default_parameters", [source.values[name] for name in model.parameters]),
        *_texts(f"{prefix}_drive_names", drives),
        *_texts(f"{prefix}_drive_units", ["m"] * width + ["m/s"] * width + ["N"] * len(model.forces)),
        *_texts(f"{prefix}_output_names", [item.name for item in model.channels]),
        *_texts(f"{prefix}_output_units", [item.unit for item in model.channels]),
        *_numbers(f"{prefix}_axle_offsets", model.wheel_offsets(source.values).tolist()),
    ]
    first = len(model.parameters)
    travels = [f"\n    model->parameters[{first + i}] = {literal(value)};" for i, value in enumerate(program.static_travels)]
    outputs = [*program.outputs, *(f"outputs[{i}] += {literal(value)};" for i, value in enumerate(program.offsets) if value)]
    residual = "0.0" if program.residual is None else f"model->state[{program.residual}]"
    return from_template(
        "model.c",
        prefix,
        VERSION=versions(())["vehgen"],
        TABLES="\n".join(tables),
        HELPERS="".join(f"{line}\n" for line in program.helpers),
        TRAVELS="".join(travels),
        BOUND=str(len(model.vehicle.free_parameters) if program.is_bound else 0),
        SETUP=_body(program.setup, ["parameters", "dt", "constants"]),
        STEP=_body([*_arrays(program.step, "double"), *program.step], ["model", "drives"]),
        OUTPUTS=_body([*_arrays(outputs, "const double"), *outputs], ["model", "drives", "outputs"]),
        RESIDUAL=residual,
        RESIDUAL_LIMIT=literal(program.residual_limit),
    )  # fmt: skip


def _arrays(lines: Sequence[str], state: str) -> list[str]:
    """Return the declarations of the parts of the model that statements use; `state` is the type of its numbers."""
    text = "\n".join(lines)
    kinds = {"constants": "const double *const", "state": f"{state} *const"}
    found = [f"{kind} {name} = model->{name};" for name, kind in kinds.items() if re.search(rf"\b{name}\[", text)]
    return [*found, "const double dt = model->dt;"] if re.search(r"\bdt\b", text) else found


def _body(lines: Sequence[str], arguments: Sequence[str]) -> str:
    """Return the statements of a function; an argument that they do not use is said to be so."""
    text = "\n".join(lines)
    silent = [f"(void){name};" for name in arguments if not re.search(rf"\b{name}\b", text)]
    return "\n".join(f"    {line}" for line in (*lines, *silent))


def _texts(name: str, items: Sequence[str]) -> list[str]:
    return _table("const char *const", name, [c_text(item) for item in items] or ['""'])


def _numbers(name: str, items: Sequence[float]) -> list[str]:
    return _table("const double", name, [literal(item) for item in items] or ["0.0"])


def _table(kind: str, name: str, items: Sequence[str]) -> list[str]:
    return [f"{kind} {name}[{len(items)}] = {{", *(f"    {item}," for item in items), "};"]
