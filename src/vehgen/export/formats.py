"""The formats of an export: what each is called, its suffix, and what writes it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from vehgen.export.c_files import write_c
from vehgen.export.data_files import write_json, write_npz
from vehgen.export.fmu import write_fmu2, write_fmu3
from vehgen.export.identifiers import identifier
from vehgen.export.matlab import write_m, write_mat, write_state_space
from vehgen.export.report_text import write_latex, write_markdown
from vehgen.export.source import ExportSource
from vehgen.export.vbi2d import write_vbi2d
from vehgen.files.names import as_name


@dataclass(frozen=True)
class Format:
    """A format: what it is for in a few words, the suffix of its file (none for a folder), and what writes it.

    `write` returns the bytes of every file by its name; those of a folder stand in it. `stem` names the file after a vehicle. `keeps_laws`
    tells whether force laws stay in it where `linear` leaves them out elsewhere.
    """

    meaning: str
    suffix: str
    write: Callable[[ExportSource], dict[str, bytes]]
    stem: Callable[[str], str] = as_name
    keeps_laws: bool = False


EXPORT_FORMATS: dict[str, Format] = {
    "json": Format("matrices, names, units, parameters, static loads and force laws, with a schema", ".json", write_json),
    "npz": Format("the same as NumPy arrays", ".npz", write_npz),
    "mat": Format("the same as a MAT-file", ".mat", write_mat),
    "m": Format("the same as a function file of MATLAB or GNU Octave, to be read", ".m", write_m, identifier),
    "c": Format("the step that kernels run as C99: header, source, an example that drives over a hump", "", write_c, keeps_laws=True),
    "state-space": Format("A, B, C, D with the names and units of states, inputs and outputs, as a MAT-file", ".mat", write_state_space),
    "vbi2d": Format("the vehicle struct of VBI-2D and VEqMon2D", ".mat", write_vbi2d),
    "fmu": Format("a co-simulation unit of FMI 2.0 with sources and, where a C compiler is, a binary", ".fmu", write_fmu2, keeps_laws=True),
    "fmu3": Format("the same of FMI 3.0", ".fmu", write_fmu3, keeps_laws=True),
    "latex": Format("the equations in symbols, to be read", ".tex", write_latex, keeps_laws=True),
    "markdown": Format("tables of the matrices in numbers, to be read", ".md", write_markdown, keeps_laws=True),
}
"""Every format by the name that it is asked for."""
