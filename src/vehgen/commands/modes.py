"""Print the natural modes: frequencies, damping, and where their energy is."""

from __future__ import annotations

import argparse

from vehgen.commands.terminal import add_vehicle, load, print_json, print_table, warn

EXAMPLE = "vehgen modes tractor5.yaml --set SHCM-1"
FREE_HZ = 1e-3
"""What is as slow as this has no stiffness but that of force laws, which modes leave out."""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the command's arguments."""
    add_vehicle(parser)


def run(options: argparse.Namespace) -> None:
    """Print the modes of a vehicle."""
    vehicle, values = load(options)
    from vehgen.simulate.mode_groups import alike_modes, group_name
    from vehgen.simulate.modes import natural_modes

    modes = natural_modes(vehicle, values)
    if vehicle.has_laws:
        warn([f"the force laws of {vehicle.name} are left out: modes are those of its springs and dampers alone"])
    warn(f"no linear stiffness holds {item.name}: 0 Hz; a spring, a tyre or a link would" for item in modes if item.undamped_hz < FREE_HZ)
    if options.json:
        keys = ("name", "undamped_hz", "damped_hz", "damping_ratio")
        print_json({"n_dof": len(modes), "modes": [{key: getattr(mode, key) for key in keys} for mode in modes]})
        return
    groups = [(group_name(group), group[0]) for group in alike_modes(modes)]
    rows = [(name, f"{mode.undamped_hz:.4f}", f"{mode.damped_hz:.4f}", f"{mode.damping_ratio:.4f}") for name, mode in groups]
    print_table(
        f"{vehicle.title or vehicle.name}: natural modes",
        ("mode", "undamped, Hz", "damped, Hz", "damping ratio"),
        rows,
        right=(1, 2, 3),
    )
