"""What quantities of a file are called in a kernel's source: numbers, never their names, as the source is imported as code; and the legend.

Labels of a kind are equally long, so that the layout of the source, which follows the length of its lines, does not follow the numbers.
"""

from __future__ import annotations

from vehgen.mechanics.equations_of_motion import EquationsOfMotion


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


def kernel_legend(model: EquationsOfMotion) -> str:
    """Return which number in a kernel's source is which coordinate, parameter, input, force and channel of a model, with units.

    It quotes names and meanings of the vehicle file, and so must never become part of a source.
    """
    vehicle = model.vehicle
    dimensions = vehicle.dimensions
    width = len(model.inputs)
    drives = drive_labels(width, len(model.forces))

    def described(name: str) -> str:
        if name not in dimensions:
            return f"{name} [m]"  # how far a sensor or force is moved forward
        meaning = vehicle.parameters[name].meaning
        return f"{name} [{dimensions[name]}]{f': {meaning}' if meaning else ''}"

    sections = {
        "Coordinates (u displacement, v velocity)": [
            f"u{i}, v{i}: {item.name} [{item.unit}], {item.meaning}" for i, item in enumerate(model.coordinates)
        ],
        "Springs (e twice the force; o of all that act on that coordinate alone)": [
            f"e{i}: {element.kind} {element.name}" for i, element in enumerate(model.elements)
        ],
        "Parameters": [f"{parameter_label(i)}: {described(name)}" for i, name in enumerate(model.parameters)],
        "Parameters that follow from them": [
            f"{dependent_label(i)}: {described(symbol.name)}" for i, (symbol, _) in enumerate(model.definitions)
        ],
        "Inputs, displacement [m] and rate [m/s]": [f"{drives[i]}, {drives[i + width]}: {name}" for i, name in enumerate(model.inputs)],
        "Forces [N]": [f"{drives[i + 2 * width]}: {name}" for i, name in enumerate(model.forces)],
        "Channels": [f"{i}: {item.name}, {item.quantity} [{item.unit}]" for i, item in enumerate(model.channels)],
    }
    lines = [f"Legend of the Newmark kernel of {vehicle.name}"]
    for title, entries in sections.items():
        lines += ["", title, *(f"    {' '.join(entry.split())}" for entry in entries or ["none"])]
    return "\n".join(lines) + "\n"
