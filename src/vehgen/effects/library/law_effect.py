"""Effects that are a force law on a suspension, tyre or hinge."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from vehgen.effects.base import Change, EffectParameter, Symbols
from vehgen.effects.kinds import VehicleEffect
from vehgen.effects.locator import EffectSite, Size
from vehgen.effects.places import EVERY_TYRE, hinges, suspensions
from vehgen.files.expressions import Expression
from vehgen.mechanics.laws import LAWS


@dataclass(frozen=True)
class LawEdit:
    """The edit that adds a law to a suspension (or a link in its place), tyre or hinge.

    Attributes
    ----------
    kind
        `suspension`, `tyre` or `hinge`.
    law
        Its name in the library.
    write
        Returns the law's entry from the symbols (default: each of its parameters is the symbol of that name).
    """

    kind: str
    law: str
    write: Callable[[EffectSite, Symbols], Change] | None = None

    def __call__(self, site: EffectSite, symbols: Symbols) -> Change:
        """Return the change of the vehicle at a site."""
        entry = {self.law: self.write(site, symbols) if self.write else dict(symbols)}
        if self.kind == "hinge":
            return {"hinges": {site.place: {"laws": [*site.laws(self.kind, site.place), entry]}}}
        if self.kind == "suspension":
            return on_spring(site, {"laws": [*site.laws(site.kind, site.place), entry]})
        names = list(site.vehicle.axles) if site.place in EVERY_TYRE else [site.place]
        return {"axles": {name: {self.kind: {"laws": [*site.laws(self.kind, name), entry]}} for name in names}}


def on_spring(site: EffectSite, change: Change) -> Change:
    """Return a change of the suspension or link at a site, in the form of a vehicle file."""
    return {"links": {site.place: change}} if site.kind == "link" else {"axles": {site.place: {"suspension": change}}}


def in_place_of_dashpot(site: EffectSite, law: Change) -> Change:
    """Return a change of the suspension or link at a site that moves its dashpot into a law: nothing stands beside it."""
    return on_spring(site, {"c": Expression.quantity(0, "N s/m"), "laws": [*site.laws(site.kind, site.place), law]})


def suspension_law(
    *,
    name: str,
    law: str,
    signature: str,
    parameters: tuple[EffectParameter, ...],
    frees: tuple[Size, ...] = (),
    special_case: str = "",
) -> VehicleEffect:
    """Return the effect of a law of the library on a suspension or link."""
    known = LAWS[law]
    return VehicleEffect(
        name=name,
        title=known.title,
        equation=known.equation,
        meaning=known.meaning,
        signature=signature,
        source=known.source,
        attaches="suspension",
        places=suspensions,
        parameters=parameters,
        frees=frees,
        special_case=special_case,
        edit=LawEdit("suspension", law),
    )


def hinge_law(*, name: str, law: str, title: str, meaning: str, signature: str, parameters: tuple[EffectParameter, ...]) -> VehicleEffect:
    """Return the effect of a law of the library on a hinge."""
    known = LAWS[law]
    return VehicleEffect(
        name=name,
        title=title,
        equation=known.equation,
        meaning=meaning,
        signature=signature,
        source=known.source,
        attaches="hinge",
        places=hinges,
        parameters=parameters,
        edit=LawEdit("hinge", law),
    )
