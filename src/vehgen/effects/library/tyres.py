"""Tyres that touch the road along a length, leave it, or damp."""

from __future__ import annotations

from dataclasses import dataclass, replace

from vehgen.effects.base import Change, EffectParameter, Symbols
from vehgen.effects.evidence import Residual
from vehgen.effects.kinds import RunEffect, VehicleEffect
from vehgen.effects.library.law_effect import LawEdit
from vehgen.effects.locator import EffectLocator, EffectSite
from vehgen.effects.places import EACH_TYRE, EVERY_TYRE, all_tyres, tyres, tyres_alike_or_each
from vehgen.files.expressions import Expression
from vehgen.files.names import joined_name
from vehgen.fit.adjustments import Footprint
from vehgen.mechanics.laws import LAWS
from vehgen.vehicle import Vehicle

TYRE_FOOTPRINT_EFFECT = RunEffect(
    name="tyre_footprint",
    title="Tyre footprint",
    equation="w(s) = mean of the road over s - length/2 to s + length/2",
    meaning="a tyre averages the road over its contact length; a point contact sees every edge",
    signature="too much high frequency in the simulation at every axle, with nulls at speed/length",
    source="D. Cebon, Handbook of Vehicle-Road Interaction, 1999, ISBN 9789026515545",
    attaches="tyre",
    places=all_tyres,
    parameters=(EffectParameter("length", "m", "contact length", low=0.01, high=0.5, starts=(0.1, 0.25)),),
    is_global=True,
    adjustment=Footprint,
    scale=0.05,
)


_LIFTOFF = LawEdit("tyre", "tyre_liftoff")


def _lift_off(site: EffectSite, symbols: Symbols) -> Change:
    return _LIFTOFF(site, {"share": Expression.quantity(1)})


TYRE_LIFTOFF_EFFECT = VehicleEffect(
    name="tyre_liftoff",
    title=LAWS["tyre_liftoff"].title,
    equation=LAWS["tyre_liftoff"].equation,
    meaning=LAWS["tyre_liftoff"].meaning,
    signature="after a high or fast hump the wheel flies and lands: misfits right behind the hump that vanish on lower humps",
    source=LAWS["tyre_liftoff"].source,
    attaches="tyre",
    places=tyres,
    is_global=True,
    frees=("kt",),
    edit=_lift_off,
)

_TYRE_RATIO = EffectParameter("ratio", "", "damping ratio of the unsprung mass on its tyres alone", low=1e-3, high=0.5, starts=(0.02, 0.1))


def _own_name(axle: str) -> str:
    """Return the name of an axle's own ratio."""
    return joined_name(_TYRE_RATIO.name, axle)


def _edit(site: EffectSite, symbols: Symbols) -> Change:
    change: Change = {}
    for name, axle in site.vehicle.axles.items():
        if site.place in (*EVERY_TYRE, name):
            mass = site.vehicle.bodies[axle.body].mass if axle.mass is None else axle.mass
            ratio = symbols[_own_name(name) if site.place == EACH_TYRE else _TYRE_RATIO.name]
            change[name] = {"tyre": {"c": 2 * ratio * (axle.tyre.k * mass).sqrt()}}
    return {"axles": change}


@dataclass(frozen=True, kw_only=True)
class _TyreDamping(VehicleEffect):
    """Damping of one tyre, of all with one ratio, or of each with its own."""

    def at(self, place: str, vehicle: Vehicle) -> VehicleEffect:
        """Return the effect with one ratio an axle, where each tyre has its own."""
        if place != EACH_TYRE:
            return self
        own = [replace(_TYRE_RATIO, name=_own_name(name), meaning=f"{_TYRE_RATIO.meaning}, {name}") for name in vehicle.axles]
        return replace(self, parameters=tuple(own))

    def starts(self, place: str, locator: EffectLocator, residual: Residual | None = None) -> list[tuple[float, ...]]:
        """Return the starts of its ratio; where each tyre has its own, all begin alike."""
        return [(start,) * len(self.parameters) for start in _TYRE_RATIO.starts]


TYRE_DAMPING_EFFECT = _TyreDamping(
    name="tyre_damping",
    title="Tyre damping",
    equation="f = 2*ratio*sqrt(k_t*m)*v",
    meaning="rubber that loses energy as the tyre is pressed: in one tyre, in all with one ratio, or in each with its own",
    signature="axle hops decay faster and the road's high frequencies pass more strongly, at every amplitude",
    source="H. B. Pacejka, Tire and Vehicle Dynamics, 3rd ed., 2012, doi:10.1016/C2010-0-68548-8",
    attaches="tyre",
    places=tyres_alike_or_each,
    parameters=(_TYRE_RATIO,),
    is_global=True,
    frees=("kt",),
    edit=_edit,
)
