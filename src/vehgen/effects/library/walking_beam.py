"""A tandem that shares its load over a rocking beam."""

from __future__ import annotations

from vehgen.effects.base import Change, EffectParameter, Symbols
from vehgen.effects.kinds import VehicleEffect
from vehgen.effects.locator import EffectSite
from vehgen.effects.places import tandems
from vehgen.files.names import joined_name


def _edit(site: EffectSite, symbols: Symbols) -> Change:
    first, second = site.place.split("+")
    one, two = site.vehicle.axles[first], site.vehicle.axles[second]
    assert one.mass is not None
    assert two.mass is not None
    assert one.suspension is not None
    assert two.suspension is not None
    body, beam = one.body, joined_name("beam", first, second)
    m1, m2, k1, k2, c1, c2 = one.mass, two.mass, one.suspension.k, two.suspension.k, one.suspension.c, two.suspension.c
    middle, half = (one.x + two.x) / 2, (one.x - two.x) / 2
    offset = half * (m1 - m2) / (m1 + m2)
    share, pivot = symbols["share"], half * (2 * symbols["split"] - 1)
    ends = {first: half - offset, second: -(one.x - two.x) / 2 - offset}
    rests = {first: (one.x, k1, c1), second: (two.x, k2, c2)}
    return {
        "bodies": {
            beam: {
                "mass": m1 + m2,
                "pitch_inertia": 4 * m1 * m2 / (m1 + m2) * half**2,
                "carried_by": {"body": body, "x": middle + offset},
            }
        },
        "links": {
            joined_name(beam, "pivot"): {
                body: {"x": middle + pivot},
                beam: {"x": pivot - offset},
                "k": share * (k1 + k2),
                "c": share * (c1 + c2),
            },
            **{
                joined_name(beam, name): {body: {"x": x}, beam: {"x": ends[name]}, "k": (1 - share) * k, "c": (1 - share) * c}
                for name, (x, k, c) in rests.items()
            },
        },
        "axles": {name: {"body": beam, "x": end, "mass": None, "suspension": None} for name, end in ends.items()},
    }


WALKING_BEAM_EFFECT = VehicleEffect(
    name="walking_beam",
    title="Walking beam (load-sharing tandem)",
    equation="the share of k and c of both axles acts at the pivot of a beam that joins them, the rest at the axles",
    meaning="a tandem whose axles share their load; only the tyres resist the rocking",
    signature="the two axles answer as one: their separate hops and the tandem's comb of frequencies change",
    source="D. Cebon, Handbook of Vehicle-Road Interaction, 1999, ISBN 9789026515545",
    attaches="axles",
    places=tandems,
    parameters=(
        EffectParameter(
            "share", "", "share of stiffness and damping at the pivot: 1 is a beam that rocks freely", low=0.1, high=1.0, starts=(0.95, 0.6)
        ),
        EffectParameter(
            "split", "", "how far the pivot lies ahead of the rear axle, over the distance of the axles", low=0.3, high=0.7, starts=(0.5,)
        ),
    ),
    is_global=True,
    edit=_edit,
)
