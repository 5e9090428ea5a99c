"""What does it carry? Cargo files, laden vehicles, and a building module's m0, k0, c0 from finite elements."""

from vehgen.cargo.cargo_file import Cargo, CargoFile, ModuleCargo, RigidCargo, load_cargo
from vehgen.cargo.comparison import LadenComparison, compare_laden
from vehgen.cargo.laden import laden, laden_text

__all__ = [
    "Cargo",
    "CargoFile",
    "LadenComparison",
    "ModuleCargo",
    "RigidCargo",
    "compare_laden",
    "laden",
    "laden_text",
    "load_cargo",
]
