"""The legend of a kernel: what its numbered names stand for, as text for people."""

from __future__ import annotations

from vehgen.codegen.labels import dependent_label, drive_labels, parameter_label
from vehgen.mechanics.equations_of_motion import EquationsOfMotion


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
