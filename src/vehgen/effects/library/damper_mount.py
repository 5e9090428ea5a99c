"""A damper on a soft mount."""

from __future__ import annotations

import math

from vehgen.effects.base import Change, EffectParameter, Symbols
from vehgen.effects.kinds import VehicleEffect
from vehgen.effects.library.law_effect import on_spring
from vehgen.effects.locator import EffectSite
from vehgen.effects.places import dampers
from vehgen.files.expressions import Expression


def _size(site: EffectSite) -> float:
    return 2 * math.pi * site.c


def _edit(site: EffectSite, symbols: Symbols) -> Change:
    """Return the dashpot moved into a Maxwell branch of the same c: nothing stands beside it."""
    k, c = symbols["k"], site.spring.c
    law = {"relaxation": {"k": k, "time": c / k}}
    return on_spring(site, {"c": Expression.quantity(0, "N s/m"), "laws": [*site.laws(site.kind, site.place), law]})


DAMPER_MOUNT_EFFECT = VehicleEffect(
    name="damper_mount",
    title="Damper on a soft mount",
    equation="c*y' = k*(d - y) = f, in place of f = c*v; y is the travel of the dashpot",
    meaning="the damper's own mounts give: a spring in series with the dashpot, which it replaces",
    signature="slow motions are damped as before, fast ones meet the mount's stiffness: hops rise in frequency and decay more slowly",
    source=(
        "M. J. Brennan, A. Carrella, T. P. Waters, V. Lopes Jr., J. Sound Vib. 309 (2008) 823-837 (elastically connected damper), "
        "doi:10.1016/j.jsv.2007.07.074"
    ),
    attaches="suspension",
    places=dampers,
    parameters=(
        EffectParameter(
            "k",
            "N/m",
            "stiffness of the mount, in series with the dashpot",
            low=0.5,
            high=60.0,
            starts=(25.0, 8.0, 2.5),
            scale=_size,
            of="2 pi 1/s times the damping there",
        ),
    ),
    frees=("c",),
    edit=_edit,
)
"""Of a dashpot c the mount's stiffness is searched as 2 pi c f, f the frequency [Hz] above which the mount gives more than the dashpot."""
