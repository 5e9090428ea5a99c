"""Cross-sections of frame members: area, second moments and torsion constant."""

from __future__ import annotations

from dataclasses import dataclass

from pydantic import Field, model_validator
from pydantic_core import PydanticCustomError

from vehgen.cargo.quantities import Area, PositiveLength, SecondMoment
from vehgen.files.entry import FileModel


@dataclass(frozen=True)
class Section:
    """A cross-section: area [m^2], second moments for bending along its height and along its width, torsion constant [m^4]."""

    area: float
    strong: float
    weak: float
    torsion: float


class Bar(FileModel):
    """A full rectangle."""

    height: PositiveLength
    width: PositiveLength

    def section(self) -> Section:
        """Torsion constant after Young & Budynas, Roark's Formulas for Stress and Strain, 7th ed., Table 10.1 case 4 (within 4 %)."""
        h, b = self.height, self.width
        long, short = max(h, b), min(h, b)
        ratio = short / long
        torsion = long * short**3 * (1 / 3 - 0.21 * ratio * (1 - ratio**4 / 12))
        return Section(h * b, b * h**3 / 12, h * b**3 / 12, torsion)


class Walled(FileModel):
    """What the thin-walled sections share."""

    height: PositiveLength
    width: PositiveLength
    thickness: PositiveLength

    @model_validator(mode="after")
    def _hollow(self) -> Walled:
        if 2 * self.thickness >= min(self.height, self.width):
            raise PydanticCustomError(
                "joint", "a wall is less than half as thick as the section is high and wide; use `bar` for a full one"
            )
        return self


class Tube(Walled):
    """A rectangular hollow section."""

    def section(self) -> Section:
        """Torsion constant by Bredt: 4 A_m^2 t / perimeter of the middle line."""
        h, b, t = self.height, self.width, self.thickness
        hi, bi, hm, bm = h - 2 * t, b - 2 * t, h - t, b - t
        torsion = 2 * (hm * bm) ** 2 * t / (hm + bm)
        return Section(h * b - hi * bi, (b * h**3 - bi * hi**3) / 12, (h * b**3 - hi * bi**3) / 12, torsion)


class Channel(Walled):
    """A C section without lips: the web along its height, two flanges along its width."""

    def section(self) -> Section:
        """Second moments about the centroid; torsion constant of thin walls, sum of length t^3 / 3."""
        h, b, t = self.height, self.width, self.thickness
        web = h - 2 * t
        area = 2 * b * t + web * t
        strong = (b * h**3 - (b - t) * web**3) / 12
        centroid = (2 * b * t * b / 2 + web * t * t / 2) / area
        weak = 2 * (t * b**3 / 12 + b * t * (b / 2 - centroid) ** 2) + web * t**3 / 12 + web * t * (t / 2 - centroid) ** 2
        return Section(area, strong, weak, (2 * b + web) * t**3 / 3)


class Plain(FileModel):
    """Numbers from a table of sections."""

    area: Area
    strong: SecondMoment = Field(description="second moment for bending along its height: vertical for rails and joists [m^4]")
    weak: SecondMoment
    torsion: SecondMoment

    def section(self) -> Section:
        """Return the numbers as they are."""
        return Section(self.area, self.strong, self.weak, self.torsion)


class SectionEntry(FileModel):
    """One of bar, tube, channel, plain."""

    bar: Bar | None = None
    tube: Tube | None = None
    channel: Channel | None = None
    plain: Plain | None = None

    @model_validator(mode="after")
    def _one(self) -> SectionEntry:
        if sum(item is not None for item in (self.bar, self.tube, self.channel, self.plain)) != 1:
            raise PydanticCustomError("joint", "a section is one of bar, tube, channel, plain")
        return self

    def section(self) -> Section:
        """Return the cross-section's numbers."""
        entry = self.bar or self.tube or self.channel or self.plain
        assert entry is not None
        return entry.section()
