"""An assessment as tables for people: one for riders, roads, cargo, shocks and fatigue each, with what defines its numbers."""

from __future__ import annotations

import re
from dataclasses import dataclass

from vehgen.assess.result import Assessment, LevelComparison
from vehgen.files.units import STANDARD_GRAVITY
from vehgen.measure.astm import NOTE

Row = tuple[str, ...]


@dataclass(frozen=True)
class NumberTable:
    """A table of written numbers; `source` says by what they are defined."""

    title: str
    columns: Row
    rows: list[Row]
    source: str


def assessment_tables(found: Assessment) -> list[NumberTable]:
    """Return the tables that have rows."""
    tables = [_ride(found), _tyres(found), _transport(found), _shock(found), _cycles(found), _channels(found)]
    return [table for table in tables if table.rows]


def _ride(found: Assessment) -> NumberTable:
    rows = [(item.name, item.weighting, *_numbers(item.rms, item.mtvv, item.vdv, item.crest), item.reaction) for item in found.ride]
    return NumberTable(
        "Ride",
        ("place", "weighting", "RMS [m/s^2]", "MTVV [m/s^2]", "VDV [m/s^1.75]", "crest factor", "likely reaction"),
        rows,
        "ISO 2631-1:1997: weighted RMS (6.1), running RMS over 1 s (6.3.1), VDV of this duration (6.3.2), reactions (C.2.3)",
    )


def _tyres(found: Assessment) -> NumberTable:
    rows = [
        (item.axle, *_numbers(item.static / 1e3, item.coefficient, item.high, item.least, item.road_stress, item.fourth_power))
        for item in found.tyres
    ]
    return NumberTable(
        "Tyre loads and road damage",
        ("axle", "static [kN]", "DLC", "95 % [of static]", "least [of static]", "1 + 6 s^2 + 3 s^4", "mean (P/P0)^4"),
        rows,
        "dynamic load coefficient s: standard deviation over static load; Eisenmann's dynamic road stress factor (1975); mean fourth power",
    )


def _transport(found: Assessment) -> NumberTable:
    names = [re.split(r"[ (]", level.name.partition(", ")[2].removeprefix("level "))[0] for level in _levels(found)]
    rows = []
    for item in found.transport:
        second = next(level for level in item.levels if level.name.endswith("level II"))
        excess = f"{second.excess_db:+.1f} dB at {second.excess_hz:.3g} Hz"
        rows.append(
            (item.name, f"{item.band[0]:g}-{item.band[1]:g}", *_numbers(item.rms, *(item.rms / level.rms for level in item.levels)), excess)
        )
    columns = ("place", "band [Hz]", "RMS [g]", *(f"/ {name}" for name in names), "PSD over II")
    return NumberTable(
        "Transport vibration",
        columns,
        rows,
        f"overall RMS, over that of ASTM D4169 trucks (I to III; 2016: medium, low, high) in the same band ({NOTE}); Welch's PSD",
    )


def _levels(found: Assessment) -> tuple[LevelComparison, ...]:
    return found.transport[0].levels if found.transport else ()


def _shock(found: Assessment) -> NumberTable:
    rows = [(item.name, *_numbers(item.largest / STANDARD_GRAVITY, item.largest_hz)) for item in found.shock]
    quality = f"{found.shock[0].quality:g}" if found.shock else ""
    return NumberTable(
        "Shock response",
        ("place", "largest [g]", "at [Hz]"),
        rows,
        f"maximax absolute acceleration of oscillators with Q = {quality}: Smallwood's ramp-invariant filter (1981; ISO 18431-4:2007)",
    )


def _cycles(found: Assessment) -> NumberTable:
    rows = []
    for item in found.cycles:
        factor, unit = (1e3, "mm") if item.unit == "m" else (1e-3, "kN")
        rows.append((item.name, unit, f"{item.cycles:g}", *_numbers(factor * item.largest, factor * item.equivalent)))
    slope = f"{found.cycles[0].slope:g}" if found.cycles else ""
    return NumberTable(
        "Cycles",
        ("of", "unit", "cycles", "largest range", f"equivalent range at 1 Hz, m = {slope}"),
        rows,
        f"rainflow count of ASTM E1049-85, from 1 % of the largest range on; range of the same damage by Miner's rule, S-N slope {slope}",
    )


def _channels(found: Assessment) -> NumberTable:
    rows = [(item.name, item.quantity, item.unit, *_numbers(item.rms, item.peak, item.crest)) for item in found.channels]
    return NumberTable(
        "Channels", ("channel", "quantity", "unit", "RMS", "peak", "crest factor"), rows, "unweighted, about the mean of the channel"
    )


def _numbers(*values: float) -> Row:
    return tuple(f"{value:.4g}" for value in values)
