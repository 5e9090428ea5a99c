"""What is it? The typed vehicle, read and checked from its file."""

from vehgen.vehicle.given import VehicleLike, as_vehicle
from vehgen.vehicle.loading import bundled_models, find_vehicle_file, load_vehicle, parse_vehicle
from vehgen.vehicle.model import Axle, Body, Hinge, Link, Parameter, Point, Spring, Vehicle

__all__ = [
    "Axle",
    "Body",
    "Hinge",
    "Link",
    "Parameter",
    "Point",
    "Spring",
    "Vehicle",
    "VehicleLike",
    "as_vehicle",
    "bundled_models",
    "find_vehicle_file",
    "load_vehicle",
    "parse_vehicle",
]
