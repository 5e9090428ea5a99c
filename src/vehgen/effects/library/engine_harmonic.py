"""A vibration of the engine."""

from __future__ import annotations

from operator import attrgetter

from vehgen.effects.base import EffectParameter
from vehgen.effects.kinds import LineEffect
from vehgen.effects.places import pitching_bodies

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
