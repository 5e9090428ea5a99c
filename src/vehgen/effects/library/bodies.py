"""Effects of bodies: a vibration of the engine on one, and the first bending mode of a long one."""

from __future__ import annotations

from operator import attrgetter

from vehgen.effects.base import Change, EffectParameter, Symbols
from vehgen.effects.kinds import LineEffect, VehicleEffect
from vehgen.effects.locator import EffectSite
from vehgen.effects.places import long_bodies, pitching_bodies

SHAPE_ERROR = 0.0015
"""No frame bends quite as a uniform beam: with modal masses of 0.75 to 1.25 times its, frequencies strayed by 0.12 % (rms of 11)."""

TRAILER_LENGTH, CAR_LENGTH = 1.2, 1.8
"""Lengths of what bends over the distance of its outermost supports: from a trailer's a fit did not find the bending of a car."""


def _edit(site: EffectSite, symbols: Symbols) -> Change:
    """Bend a body about its pin's height, where its frame is; one without a pin about its COG."""
    bending = {name: symbols[name] for name in ("length", "frequency", "damping_ratio")}
    pins = [hinge.points[site.place].z for hinge in site.vehicle.hinges.values() if site.place in hinge.points]
    return {"bodies": {site.place: {"bending": bending | ({"z": pins[0]} if pins else {})}}}


FRAME_BENDING_EFFECT = VehicleEffect(
    name="frame_bending",
    title="Frame bending",
    equation="(m/5)*(eta'' + 2 zeta omega eta' + omega^2 eta) = force along (3 s^2 - 1)/2",
    meaning="a long frame bends between its supports, about the height of its pin if it has one",
    signature="a lightly damped resonance between body and hop frequencies; its ends move against its middle",
    source="R. D. Blevins, Formulas for Natural Frequency and Mode Shape, 1979, ISBN 9780442207106",
    attaches="body",
    places=long_bodies,
    parameters=(
        EffectParameter(
            "frequency", "Hz", "natural frequency of the free body", low=3.0, high=30.0, starts=(4.5, 7.0, 10.0, 15.0), form=SHAPE_ERROR
        ),
        EffectParameter("damping_ratio", "", "damping ratio", low=0.003, high=0.3, starts=(0.06,)),
        EffectParameter(
            "length",
            "m",
            "length over which it bends",
            low=0.8,
            high=2.5,
            starts=(TRAILER_LENGTH, CAR_LENGTH),
            scale=attrgetter("span"),
            of="the distance of the body's outermost supports, at least 1 m",
        ),
    ),
    is_global=True,
    edit=_edit,
)

ENGINE_HARMONIC_EFFECT = LineEffect(
    name="engine_harmonic",
    title="Engine harmonic",
    equation="F(t) = amplitude*sin(2 pi frequency (t + drift t^2/(2 T)) + phase)",
    meaning="an engine's firing order shakes the body it stands on: the third order of an inline six lies at 3 rpm/60",
    signature="a line in the spectrum before the hump and after it, at the same frequency in every run",
    source="Wu & Li 2023, Sect. 4.2 (the unexplained peak at 25 to 30 Hz), doi:10.3390/s23249691",
    attaches="body",
    places=pitching_bodies,
    parameters=(
        EffectParameter("frequency", "Hz", "frequency of the line at the start of a run", low=5.0, high=45.0, starts=(25.0,)),
        EffectParameter("drift", "", "relative change of the frequency over a run of T seconds", low=-0.03, high=0.03, starts=(0.0,)),
        EffectParameter(
            "amplitude",
            "N",
            "amplitude of the vertical force at the body's COG",
            low=0.0,
            high=0.1,
            starts=(0.02,),
            scale=attrgetter("load"),
            of="the static load",
        ),
    ),
    looked_for=(5.0, 40.0),
)
