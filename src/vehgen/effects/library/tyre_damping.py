"""Damping in the tyres."""

from __future__ import annotations

from vehgen.effects.base import Change, EffectParameter
from vehgen.effects.kinds import VehicleEffect
from vehgen.effects.library.law_effect import Given
from vehgen.effects.locator import EffectSite
from vehgen.effects.places import ALL_TYRES, tyres


def _edit(site: EffectSite, symbols: Given) -> Change:
    change: Change = {}
    for name, axle in site.vehicle.axles.items():
        if site.place in (ALL_TYRES, name):
            mass = axle.mass.text if axle.mass is not None else site.vehicle.bodies[axle.body].mass.text
            change[name] = {"tyre": {"c": f"2*{symbols['ratio']}*sqrt(({axle.tyre.k.text})*({mass}))"}}
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
    edit=_edit,
)
