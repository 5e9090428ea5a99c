"""A tandem that shares its load over a rocking beam."""

from __future__ import annotations

from vehgen.effects.base import Change, Effect, EffectParameter
from vehgen.effects.law_effect import Given
from vehgen.effects.places import tandems
from vehgen.effects.site import Site


def _edit(site: Site, symbols: Given) -> Change:
    first, second = site.place.split("+")
    one, two = site.vehicle.axles[first], site.vehicle.axles[second]
    assert one.mass is not None
    assert two.mass is not None
    body, beam = one.body, f"beam_{first}_{second}"
    near, far, m1, m2 = (f"({text})" for text in (one.x.text, two.x.text, one.mass.text, two.mass.text))
    middle, half = f"({near} + {far})/2", f"({near} - {far})/2"
    offset = f"{half}*({m1} - {m2})/({m1} + {m2})"
    return {
        "bodies": {
            beam: {
                "mass": f"{m1} + {m2}",
                "pitch_inertia": f"4*{m1}*{m2}/({m1} + {m2})*({half})**2",
                "carried_by": {"body": body, "x": f"{middle} + {offset}"},
            }
        },
        "links": {
            f"{beam}_pivot": {body: {"x": middle}, beam: {"x": f"-{offset}"}, "k": symbols["k"], "c": symbols["c"]},
        },
        "axles": {
            first: {"body": beam, "x": f"{half} - {offset}", "mass": None, "suspension": None},
            second: {"body": beam, "x": f"-{half} - {offset}", "mass": None, "suspension": None},
        },
    }


WALKING_BEAM = Effect(
    "walking_beam",
    "Walking beam (load-sharing tandem)",
    "both axles hang on a beam that rocks about its pivot: k and c act at the pivot alone",
    "a tandem whose axles share their load; only the tyres resist the rocking",
    "the two axles answer as one: their separate hops and the tandem's comb of frequencies change",
    "D. Cebon, Handbook of Vehicle-Road Interaction, 1999, ISBN 9789026515545",
    "axles",
    (
        EffectParameter("k", "N/m", "stiffness at the pivot", 0.2, 5.0, (1.0,), lambda site: site.k),
        EffectParameter("c", "N s/m", "damping at the pivot", 0.1, 8.0, (1.0,), lambda site: site.c),
    ),
    tandems,
    _edit,
)
