"""What is it? The typed vehicle, read and checked from its file.

Bodies, hinges, axles, links and parameters, `extends`, parameter sets, bundled models; all checks of names, units and values.
"""

from vehgen.vehicle.loading import VehicleLike, as_vehicle, bundled_models, find_vehicle_file, load_vehicle, parse_vehicle
from vehgen.vehicle.model import Vehicle
from vehgen.vehicle.parts import Axle, Bending, Body, CarriedBy, Hinge, Link, Parameter, Point, Size, Spring

__all__ = [
    "Axle",
    "Bending",
    "Body",
    "CarriedBy",
    "Hinge",
    "Link",
    "Parameter",
    "Point",
    "Size",
    "Spring",
    "Vehicle",
    "VehicleLike",
    "as_vehicle",
    "bundled_models",
    "find_vehicle_file",
    "load_vehicle",
    "parse_vehicle",
]
