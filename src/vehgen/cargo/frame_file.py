"""The frame file: a building module as a box of frame members and panels."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

from pydantic import Field

from vehgen.cargo.panels import Layer, equivalent_layer
from vehgen.cargo.quantities import DampingRatio, Density, Distance, Modulus, Poisson, PositiveLength
from vehgen.cargo.sections import SectionEntry
from vehgen.errors import InputError, shown
from vehgen.files.checks import check_known
from vehgen.files.document import Located
from vehgen.files.entry import FileModel, read_entries
from vehgen.files.names import FreeText, Identifier, Name
from vehgen.files.quantities import Frequency

MIN_SIDE, MAX_SIDE = 0.1, 30.0
"""Sides of what a road vehicle can carry [m]: nothing longer turns at a junction, and its mesh would outgrow the memory."""


class BoxSize(FileModel):
    """Length, width and height between the middle surfaces of opposite panels [m]."""

    length: PositiveLength = Field(ge=MIN_SIDE, le=MAX_SIDE)
    width: PositiveLength = Field(ge=MIN_SIDE, le=MAX_SIDE)
    height: PositiveLength = Field(ge=MIN_SIDE, le=MAX_SIDE)


class Material(FileModel):
    """An isotropic material; E may be 0 for what only weighs or keeps distance."""

    E: Modulus
    nu: Poisson
    density: Density


class Member(FileModel):
    """Beams of one kind: their material and section, the section's height being vertical (along the length for posts and studs)."""

    material: str
    section: str


class SpacedMember(Member):
    """Members at equal distances, at most `spacing` apart."""

    spacing: PositiveLength = Field(ge=0.05)


class Frame(FileModel):
    """The members: rails round the floor and the roof, four posts; joists across the width, studs in the walls."""

    bottom_rails: Member | None = None
    top_rails: Member | None = None
    posts: Member | None = None
    floor_joists: SpacedMember | None = None
    roof_joists: SpacedMember | None = None
    studs: SpacedMember | None = None

    def members(self) -> Iterator[tuple[str, Member]]:
        """Yield the declared kinds of members by name."""
        for name in Frame.model_fields:
            if (member := getattr(self, name)) is not None:
                yield name, member


class LayerEntry(FileModel):
    """A layer of a panel."""

    material: str
    thickness: PositiveLength = Field(le=1.0)


class Panel(FileModel):
    """A panel of layers, from the inside out."""

    layers: tuple[LayerEntry, ...] = Field(min_length=1)
    bonded: bool = Field(True, description="false: the layers slide on each other")


class Panels(FileModel):
    """The panels; `walls` stands for those of the four walls that are not named."""

    floor: Panel | None = None
    roof: Panel | None = None
    walls: Panel | None = None
    front: Panel | None = None
    rear: Panel | None = None
    left: Panel | None = None
    right: Panel | None = None

    def faces(self) -> Iterator[tuple[str, str, Panel]]:
        """Yield each panel that stands: the face it covers, its key in the file, itself."""
        for face in ("floor", "roof", "front", "rear", "left", "right"):
            own: Panel | None = getattr(self, face)
            if own is not None:
                yield face, face, own
            elif self.walls is not None and face not in ("floor", "roof"):
                yield face, "walls", self.walls


class DampingPoint(FileModel):
    """A damping ratio at a frequency."""

    frequency: Frequency
    ratio: DampingRatio


class MeshEntry(FileModel):
    """How finely the box is divided."""

    size: PositiveLength = Field(ge=0.01)


class FrameFile(FileModel):
    """A building module as its file declares it, quantities in SI units."""

    name: Identifier | None = None
    title: FreeText = ""
    source: FreeText = ""
    on: str
    behind: str
    front: Distance
    base: Distance = 0.0
    size: BoxSize
    materials: dict[Name, Material]
    sections: dict[Name, SectionEntry] = Field(default_factory=dict)
    frame: Frame = Field(default_factory=Frame)
    panels: Panels = Field(default_factory=Panels)
    mesh: MeshEntry
    damping: tuple[DampingPoint, DampingPoint]
    mass: Literal["total", "effective"] = "total"


def rayleigh(first: DampingPoint, second: DampingPoint) -> tuple[float, float]:
    """Return alpha [1/s] and beta [s] of C = alpha M + beta K with zeta = (alpha/w + beta w)/2 at two points."""
    w1, w2 = 2 * math.pi * first.frequency, 2 * math.pi * second.frequency
    alpha = 2 * w1 * w2 * (first.ratio * w2 - second.ratio * w1) / (w2**2 - w1**2)
    beta = 2 * (second.ratio * w2 - first.ratio * w1) / (w2**2 - w1**2)
    tiny = 1e-12 * max(first.ratio, second.ratio)
    return (0.0 if abs(alpha) < tiny * w1 else alpha), (0.0 if abs(beta) < tiny / w1 else beta)


@dataclass(frozen=True)
class FrameModule:
    """A checked frame file with the places of its values."""

    file: FrameFile
    path: Path
    document: Located

    def layer(self, panel: Panel) -> Layer:
        """Return a panel's equivalent single layer."""
        found = (self.file.materials[entry.material] for entry in panel.layers)
        layers = [Layer(entry.thickness, item.E, item.nu, item.density) for entry, item in zip(panel.layers, found, strict=True)]
        return equivalent_layer(layers, panel.bonded)


def load_frame(path: str | Path) -> FrameModule:
    """Read and check a frame file.

    Raises
    ------
    InputError
        With file, line and column, what is wrong and what would be right.
    """
    path = Path(path)
    file, document = read_entries(FrameFile, path)
    frame = FrameModule(file, path, document)
    _check(frame)
    return frame


def _check(frame: FrameModule) -> None:
    file, document = frame.file, frame.document

    first, second = file.damping
    place = document.find(("damping",))
    if math.isclose(first.frequency, second.frequency):
        raise InputError("Rayleigh damping needs ratios at two different frequencies", place)
    if min(rayleigh(first, second)) < 0:
        reason = "mass or stiffness damping would be negative; choose ratios nearer to each other"
        raise InputError(f"no Rayleigh damping has these two ratios: {reason}", place)
    for name, member in file.frame.members():
        check_known(member.material, file.materials, "no material", document, "frame", name, "material")
        check_known(member.section, file.sections, "no section", document, "frame", name, "section")
        if file.materials[member.material].E == 0:
            raise InputError(
                f"a frame member needs a material with E above 0; {shown(member.material)} has none", document.find(("frame", name))
            )
    for _, key, panel in file.panels.faces():
        for index, layer in enumerate(panel.layers):
            check_known(layer.material, file.materials, "no material", document, "panels", key, "layers", index, "material")
        if not any(file.materials[layer.material].E > 0 for layer in panel.layers):
            raise InputError("a panel needs a layer with E above 0", document.find(("panels", key)))
    if not any(True for _ in file.panels.faces()) and not any(True for _ in file.frame.members()):
        raise InputError("a module needs frame members or panels", document.position)
