"""The cargo file: what a vehicle carries, and where on it."""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path

from pydantic import Field, model_validator
from pydantic_core import PydanticCustomError

from vehgen.cargo.quantities import (
    Damping,
    DampingRatio,
    Distance,
    Inertia,
    Mass,
    OptionalMass,
    PositiveLength,
    Stiffness,
    check_derived,
)
from vehgen.files.document import Located
from vehgen.files.entry import FileModel, read_entries
from vehgen.files.names import FreeText, Identifier
from vehgen.files.quantities import Frequency
from vehgen.files.units import DAMPING, STIFFNESS


class RigidCargo(FileModel):
    """A uniform box that moves as one with its carrier (Wu & Li 2023, Fig. 7, doi:10.3390/s23249691)."""

    mass: Mass
    length: PositiveLength
    height: PositiveLength
    front: Distance = Field(description="its front behind the place that `behind` names [m]")
    base: Distance = Field(0.0, description="its floor above the hinge that `behind` names, else above the carrier's COG [m]")
    pitch_inertia: Inertia | None = Field(None, description="about its COG; without it that of a uniform box")

    @property
    def cog(self) -> tuple[float, float]:
        """The COG behind its front and above its floor [m]."""
        return self.length / 2, self.height / 2


class Cog(FileModel):
    """Where a module's COG lies [m]."""

    behind_front: Distance
    above_floor: Distance


class ModuleCargo(FileModel):
    """A mass on a vertical spring and damper (Wu & Li 2023, Fig. 8, doi:10.3390/s23249691)."""

    mass: Mass
    stiffness: Stiffness | None = None
    damping: Damping | None = None
    frequency: Frequency | None = Field(None, description="instead of `stiffness`: f0 in k0 = (2 pi f0)^2 mass [Hz]")
    damping_ratio: DampingRatio | None = Field(None, description="instead of `damping`: zeta in c0 = 2 zeta sqrt(k0 mass)")
    cog: Cog
    front: Distance
    base: Distance = 0.0
    pitch_inertia: Inertia = Field(0.0, description="about its COG; the module pitches with its carrier")
    fixed_mass: OptionalMass = Field(0.0, description="mass at the same COG that moves with the carrier, not on the spring [kg]")

    @model_validator(mode="after")
    def _one_spring(self) -> ModuleCargo:
        for first, second in (("stiffness", "frequency"), ("damping", "damping_ratio")):
            if (getattr(self, first) is None) == (getattr(self, second) is None):
                reason = f"a module has either `{first}` or `{second}`"
                raise PydanticCustomError("joint", "{reason}", {"reason": reason})
        return self

    @property
    def k0(self) -> float:
        """Stiffness of its spring [N/m]."""
        if self.stiffness is not None:
            return self.stiffness
        assert self.frequency is not None
        return (2 * math.pi * self.frequency) ** 2 * self.mass

    @property
    def c0(self) -> float:
        """Damping of its damper [N s/m]."""
        if self.damping is not None:
            return self.damping
        assert self.damping_ratio is not None
        return 2 * self.damping_ratio * math.sqrt(self.k0 * self.mass)


class CargoFile(FileModel):
    """A cargo as its file declares it, quantities in SI units."""

    name: Identifier | None = Field(None, description="of the body it becomes (default: cargo, or module)")
    title: FreeText = ""
    source: FreeText = ""
    on: str = Field(description="the body that carries it")
    behind: str = Field(description="a hinge or axle of that body, or the body itself (its COG)")
    rigid: RigidCargo | None = None
    module: ModuleCargo | None = None

    @model_validator(mode="after")
    def _one_load(self) -> CargoFile:
        if (self.rigid is None) == (self.module is None):
            raise PydanticCustomError("joint", "a cargo is either `rigid` or a `module`")
        return self


@dataclass(frozen=True)
class Cargo:
    """A checked cargo file with the places of its values."""

    file: CargoFile
    path: Path
    document: Located

    @property
    def load(self) -> RigidCargo | ModuleCargo:
        """What is carried."""
        load = self.file.rigid or self.file.module
        assert load is not None
        return load


def load_cargo(path: str | Path) -> Cargo:
    """Read and check a cargo file.

    Raises
    ------
    InputError
        With file, line and column, what is wrong and what would be right.
    """
    path = Path(path)
    file, document = read_entries(CargoFile, path)
    if file.module is not None:
        place = document.find(("module",), key=True)
        check_derived(file.module.k0, STIFFNESS, "the module's stiffness", place)
        check_derived(file.module.c0, DAMPING, "the module's damping", place)
    return Cargo(file, path, document)
