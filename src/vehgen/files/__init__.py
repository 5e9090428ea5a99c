"""Which files are read and written? Whole or not at all, never over what was read, never over what vehgen did not write itself."""

from vehgen.files.inputs_seen import note_read, noting_reads, was_read
from vehgen.files.outputs import check_result, check_results, guarding_results, write_bytes, write_text

__all__ = [
    "check_result",
    "check_results",
    "guarding_results",
    "note_read",
    "noting_reads",
    "was_read",
    "write_bytes",
    "write_text",
]
