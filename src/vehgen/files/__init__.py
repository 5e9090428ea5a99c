"""How are files read and written? Whole or not at all, and never over what was read.

YAML with the place of every value, expressions with their units, limits of quantities, tables, results and the list of them.
"""

from vehgen.files.inputs_seen import collecting_reads, note_read, noting_reads, was_read
from vehgen.files.outputs import check_result, check_results, guarding_results, write_bytes, write_text

__all__ = [
    "check_result",
    "check_results",
    "collecting_reads",
    "guarding_results",
    "note_read",
    "noting_reads",
    "was_read",
    "write_bytes",
    "write_text",
]
