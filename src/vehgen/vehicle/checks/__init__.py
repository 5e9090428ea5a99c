"""What must hold for a vehicle? Checks before its equations are derived; each failure names its place and what would be right."""

from __future__ import annotations

from vehgen.errors import InputError
from vehgen.files.limits import MOST_PARTS
from vehgen.vehicle.checks.graph import check_carriers, check_circles, check_connections, check_hinges, check_placement
from vehgen.vehicle.checks.names import check_names
from vehgen.vehicle.checks.silenced import check_silenced
from vehgen.vehicle.checks.units import check_units
from vehgen.vehicle.checks.values import check_all_values, check_values, complete_values
from vehgen.vehicle.model import Vehicle

__all__ = ["check_values", "check_vehicle", "complete_values"]


def check_vehicle(vehicle: Vehicle) -> None:
    """Check numbers of parts, names, connections, symbols, units and values; raises InputError at the first fault."""
    for kind, most in MOST_PARTS.items():
        if (count := len(getattr(vehicle, kind))) > most:
            raise InputError(f"{count} {kind}; a vehicle has at most {most}", vehicle.position(kind, key=True))
    check_names(vehicle)
    check_silenced(vehicle)
    check_circles(vehicle)
    check_units(vehicle)
    check_connections(vehicle)
    check_hinges(vehicle)
    check_carriers(vehicle)
    check_placement(vehicle)
    check_all_values(vehicle)
