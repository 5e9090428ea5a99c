"""Wheels that are not true."""

from __future__ import annotations

from vehgen.effects.base import EffectParameter
from vehgen.effects.kinds import WheelEffect
from vehgen.effects.places import wheels

DISTANCE_ERROR = 0.002
"""So well are ways along a road known: over a measured profile a wheel's turns are counted in the metres of the profiler's odometer."""

WHEEL_RUNOUT_EFFECT = WheelEffect(
    name="wheel_runout",
    title="Wheel run-out",
    equation="w(s) = sum over k = 1, 2, 3 of a_k*cos(k s/radius + phase_k)",
    meaning="an untrue, unevenly worn or unbalanced wheel lifts its axle once, twice and three times a turn",
    signature="lines in the spectrum before the hump and after it, at multiples of speed/(2 pi radius)",
    source="T. D. Gillespie, Fundamentals of Vehicle Dynamics, 1992, ISBN 9781560911999 (tire/wheel assembly)",
    attaches="tyre",
    places=wheels,
    parameters=(
        EffectParameter("radius", "m", "rolling radius", low=0.15, high=0.9, starts=(0.3, 0.5), form=DISTANCE_ERROR),
        EffectParameter("amplitude", "m", "amplitude of the first order, as a height of the road", low=0.0, high=0.02, starts=(0.003,)),
    ),
)
