"""Damping in the tyres."""

from __future__ import annotations

from vehgen.effects.base import Change, EffectParameter, Symbols
from vehgen.effects.kinds import VehicleEffect
from vehgen.effects.locator import EffectSite
from vehgen.effects.places import ALL_TYRES, tyres


def _edit(site: EffectSite, symbols: Symbols) -> Change:
    change: Change = {}
    for name, axle in site.vehicle.axles.items():
        if site.place in (ALL_TYRES, name):
            mass = site.vehicle.bodies[axle.body].mass if axle.mass is None else axle.mass
            change[name] = {"tyre": {"c": 2 * symbols["ratio"] * (axle.tyre.k * mass).sqrt()}}
    return {"axles": change}


TYRE_DAMPING_EFFECT = VehicleEffect(
    name="tyre_damping",
    title="Tyre damping",
    equation="f = 2*ratio*sqrt(k_t*m)*v",
    meaning="rubber that loses energy as the tyre is pressed",
    signature="axle hops decay faster and the road's high frequencies pass more strongly, at every amplitude",
    source="H. B. Pacejka, Tire and Vehicle Dynamics, 3rd ed., 2012, doi:10.1016/C2010-0-68548-8",
    attaches="tyre",
    places=tyres,
    parameters=(
        EffectParameter("ratio", "", "damping ratio of the unsprung mass on its tyres alone", low=1e-3, high=0.5, starts=(0.02, 0.1)),
    ),
    is_global=True,
    frees=("kt",),
    edit=_edit,
)
