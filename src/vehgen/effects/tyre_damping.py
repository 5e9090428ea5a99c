"""Damping in the tyres."""

from __future__ import annotations

from vehgen.effects.base import Change, Effect, EffectParameter
from vehgen.effects.law_effect import Given
from vehgen.effects.places import ALL_TYRES, tyres
from vehgen.effects.site import Site


def _edit(site: Site, symbols: Given) -> Change:
    stiffness = {name: axle.tyre.k.text for name, axle in site.vehicle.axles.items() if site.place in (ALL_TYRES, name)}
    return {"axles": {name: {"tyre": {"c": f"{symbols['time']}*({k})"}} for name, k in stiffness.items()}}


TYRE_DAMPING = Effect(
    "tyre_damping",
    "Tyre damping",
    "f = time*k_t*v",
    "rubber that loses energy as the tyre is pressed; the same loss factor in all tyres",
    "axle hops decay faster and the road's high frequencies pass more strongly, at every amplitude",
    "H. B. Pacejka, Tire and Vehicle Dynamics, 3rd ed., 2012, doi:10.1016/C2010-0-68548-8",
    "tyre",
    (EffectParameter("time", "s", "damping over stiffness of every tyre", 1e-5, 0.01, (3e-4, 2e-3)),),
    tyres,
    _edit,
)
