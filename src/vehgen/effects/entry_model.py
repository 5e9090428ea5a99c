"""The form of a file of effects: what its entries may say, before what they say is checked."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from vehgen.files.entry import FileModel
from vehgen.files.expressions import Expression
from vehgen.files.names import FreeText, Identifier, Name
from vehgen.files.units import DAMPING, FORCE, INERTIA, LENGTH, MASS, STIFFNESS, Dimension

LawPlace = Literal["suspension", "tyre", "hinge"]
RunQuantity = Literal["speed", "footprint", "gain", "delay", "tilt", "position"]
Finite = Annotated[float, Field(allow_inf_nan=False)]
SIZES: dict[str, Dimension] = {
    "load": FORCE,
    "k": STIFFNESS,
    "c": DAMPING,
    "kt": STIFFNESS,
    "mass": MASS,
    "inertia": INERTIA,
    "length": LENGTH,
    "travel": LENGTH,
}
"""What `times` may use: the sizes of a :class:`~vehgen.effects.locator.EffectSite`."""


class ParameterEntry(FileModel):
    """A parameter of an effect: searched from `low` to `high`, begun at each of `starts`."""

    meaning: FreeText
    unit: str = Field("", description="of its values, e.g. N/m^3")
    low: Finite
    high: Finite
    starts: tuple[Finite, ...] = Field(min_length=1, description="where searches begin, one to three values")
    times: Expression | None = Field(
        None, description=f"low, high and starts are multiples of this size of the place, an expression of {', '.join(SIZES)}"
    )


class LineEntry(FileModel):
    """A line of the spectrum, driven by a force at a body: its frequency is looked for between two frequencies."""

    low: Expression = Field(description="lowest frequency, e.g. 20 Hz")
    high: Expression = Field(description="highest frequency, e.g. 60 Hz")


class EffectEntry(FileModel):
    """An effect that could be missing: of the vehicle (`law` or `force`), of its runs and sensors (`adjusts`), or a `line`."""

    title: FreeText
    meaning: FreeText = Field(description="what it is")
    signature: FreeText = Field("", description="what it looks like in recordings")
    source: FreeText = Field("", description="where it comes from")
    attaches: LawPlace | None = Field(None, description="where a `law` or `force` acts")
    law: dict[Name, dict[Name, Expression]] | None = Field(None, description="{law of the library: {its parameter: value or expression}}")
    force: Expression | None = Field(None, description="an expression of travel d, rate v and the effect's parameters")
    adjusts: RunQuantity | None = Field(None, description="what its one parameter is, in all runs")
    line: LineEntry | None = Field(None, description="a vibration of every body that pitches, its amplitude and phase solved in every run")
    global_: bool | None = Field(None, alias="global", description="true: tried wherever a force at a single place does not suffice")
    parameters: dict[Identifier, ParameterEntry] = Field(default_factory=dict)


class EffectsFile(FileModel):
    """A file of effects, by name."""

    effects: dict[Identifier, EffectEntry]
