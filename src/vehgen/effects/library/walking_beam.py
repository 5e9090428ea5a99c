"""A tandem that shares its load over a rocking beam."""

from __future__ import annotations

from vehgen.effects.base import Change, EffectParameter
from vehgen.effects.kinds import VehicleEffect
from vehgen.effects.library.law_effect import Given
from vehgen.effects.locator import EffectSite
from vehgen.effects.places import tandems
from vehgen.files.names import joined_name
from vehgen.vehicle.parts import Spring


def _spring(suspension: Spring) -> tuple[str, str]:
    return suspension.k.text, suspension.c.text


def _edit(site: EffectSite, symbols: Given) -> Change:
    first, second = site.place.split("+")
    one, two = site.vehicle.axles[first], site.vehicle.axles[second]
    assert one.mass is not None
    assert two.mass is not None
    assert one.suspension is not None
    assert two.suspension is not None
    body, beam = one.body, joined_name("beam", first, second)
    near, far, m1, m2 = (f"({text})" for text in (one.x.text, two.x.text, one.mass.text, two.mass.text))
    k1, c1, k2, c2 = (f"({text})" for text in (*_spring(one.suspension), *_spring(two.suspension)))
    middle, half = f"({near} + {far})/2", f"({near} - {far})/2"
    offset = f"{half}*({m1} - {m2})/({m1} + {m2})"
    share, pivot = symbols["share"], f"{half}*(2*{symbols['split']} - 1)"
    ends = {first: (near, f"{half} - {offset}", k1, c1), second: (far, f"-{half} - {offset}", k2, c2)}
    return {
        "bodies": {
            beam: {
                "mass": f"{m1} + {m2}",
                "pitch_inertia": f"4*{m1}*{m2}/({m1} + {m2})*({half})**2",
                "carried_by": {"body": body, "x": f"{middle} + {offset}"},
            }
        },
        "links": {
            joined_name(beam, "pivot"): {
                body: {"x": f"{middle} + {pivot}"},
                beam: {"x": f"{pivot} - {offset}"},
                "k": f"{share}*({k1} + {k2})",
                "c": f"{share}*({c1} + {c2})",
            },
            **{
                joined_name(beam, name): {body: {"x": x}, beam: {"x": end}, "k": f"(1 - {share})*{k}", "c": f"(1 - {share})*{c}"}
                for name, (x, end, k, c) in ends.items()
            },
        },
        "axles": {
            first: {"body": beam, "x": f"{half} - {offset}", "mass": None, "suspension": None},
            second: {"body": beam, "x": f"-{half} - {offset}", "mass": None, "suspension": None},
        },
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
