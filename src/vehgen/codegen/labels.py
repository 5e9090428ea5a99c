"""What the quantities of a file are called in a kernel's source: numbers, never their names, because the source is imported as code.

Labels of a kind are equally long, so that the layout of the source, which follows the length of its lines, does not follow the numbers.
"""

from __future__ import annotations


def parameter_label(number: int) -> str:
    """Return the label of a parameter that is a column of the population."""
    return f"p_{number:02d}"


def dependent_label(number: int) -> str:
    """Return the label of a parameter that follows from others."""
    return f"q_{number:02d}"


def drive_labels(n_inputs: int, n_forces: int) -> list[str]:
    """Return the labels of the displacement inputs, of their rates and of the applied forces."""
    return [
        *(f"w_input_{i:04d}" for i in range(n_inputs)),
        *(f"dw_input_{i:04d}" for i in range(n_inputs)),
        *(f"f_{i:02d}" for i in range(n_forces)),
    ]
