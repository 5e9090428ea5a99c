"""Springs at dampers: a mount in series with one, a spring beside one where the file has none."""

from __future__ import annotations

import math
from operator import attrgetter

from vehgen.effects.base import Change, EffectParameter, Symbols
from vehgen.effects.kinds import VehicleEffect
from vehgen.effects.library.law_effect import in_place_of_dashpot, on_spring
from vehgen.effects.locator import EffectSite
from vehgen.effects.places import dampers, springless


def _size(site: EffectSite) -> float:
    return 2 * math.pi * site.c


def _mount(site: EffectSite, symbols: Symbols) -> Change:
    """Return the dashpot moved into a Maxwell branch of the same c."""
    k, c = symbols["k"], site.spring.c
    return in_place_of_dashpot(site, {"relaxation": {"k": k, "time": c / k}})


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
    edit=_mount,
)
"""Of a dashpot c the mount's stiffness is searched as 2 pi c f, f the frequency [Hz] above which the mount gives more than the dashpot."""


def _add(site: EffectSite, symbols: Symbols) -> Change:
    return on_spring(site, {"k": symbols["k"]})


ADDED_STIFFNESS_EFFECT = VehicleEffect(
    name="added_stiffness",
    title="A spring that the file does not have",
    equation="f = k*d",
    meaning="gas under pressure in a damper, a bushing, a hose or a cable that pulls back, where the file declares no stiffness",
    signature="slow motions meet a force that follows the travel; what the file lets drift comes back, or rings",
    source="J. C. Dixon, The Shock Absorber Handbook, 2nd ed., Wiley 2007 (gas-pressurised dampers), doi:10.1002/9780470516430",
    attaches="suspension",
    places=springless,
    parameters=(
        EffectParameter(
            "k",
            "N/m",
            "stiffness beside what is there",
            low=0.003,
            high=10.0,
            starts=(0.03, 0.3),
            scale=attrgetter("k"),
            of="the largest force that occurs over the largest travel",
        ),
    ),
    frees=("c",),
    edit=_add,
)
