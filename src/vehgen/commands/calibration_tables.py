"""What `calibrate` prints for people: what is told first, then single parameters, the runs, and what would help most."""

from __future__ import annotations

from itertools import groupby
from typing import TYPE_CHECKING

from vehgen.commands.terminal import print_table, say, warn
from vehgen.files.number_text import interval_words

if TYPE_CHECKING:
    from vehgen.calibrate.result import CalibrationSummary, ConditionSummary, FactAdvice, HeldMasses

MAX_CHI2 = 1.2
"""Above this the residuals are larger than the noise model allows."""
UNEXPLAINED_AREA = 0.9
"""Where PSDs lie so far apart the fit explains next to nothing; of vehicles that fit, also over rough roads, 0.7 was the most."""
ROUGHEST_ROAD = "D"
"""A calibration's road is of this class of ISO 8608 at most."""
FAR_OFF_SIGMAS = 3.0
"""A run's condition this far off what was known is doubtful."""
PASSED_FOR_NOISE = (
    "what the fit leaves passed for noise or a rough road, so that chi2 may not show it. Is a channel exchanged, turned, dead or in "
    "another unit, or does the model lack something? Look at the figures, and let `diagnose` look for it"
)
NEVER_LEFT_OUT = ("delay", "speed", "height", "clock")
"""Conditions of a run that are told however near they are to what was known; others only from LITTLE_OFF_SIGMAS on."""
LITTLE_OFF_SIGMAS = 1.0
WORTH_ASKING = 0.8
"""A fact that leaves more than this share of the intervals' widths is not asked for."""
EVENLY = 0.05
"""Parameters that change by so nearly as many percent as the masses do are told in one breath."""
MOST_NAMES = 8
"""So many parameters a message lists."""


def show_calibration(outcome: CalibrationSummary) -> None:
    """Print a calibration's tables, then what is to be known of them."""
    level = f"{outcome.confidence:.0%}".replace("%", " %")
    if outcome.modes:
        modes = [
            (
                mode.name,
                f"{mode.undamped_hz:.3f}",
                _to_three_decimals(mode.interval),
                f"{mode.damping_ratio:.3f}",
                _to_three_decimals(mode.damping_interval),
            )
            for mode in outcome.modes
        ]
        columns = ("mode", "undamped [Hz]", f"{level} interval", "damping ratio", f"{level} interval")
        print_table(f"{outcome.vehicle}: natural modes", columns, modes, right=(1, 3))
    if outcome.combinations:
        rows = [
            (name, f"{item.value:.5g}", item.unit, "unidentifiable" if item.interval is None else interval_words(item.interval))
            for name, item in outcome.combinations.items()
        ]
        print_table("combinations of parameters", ("combination", "value", "unit", f"{level} interval"), rows, right=(1,))
    _show_parameters(outcome, level)
    _show_runs(outcome)
    print_table(
        "objective (Eq. 5), the runs as they were fitted",
        ("channel", "area between the PSDs over the measured one's"),
        [(name, f"{value:.4f}") for name, value in outcome.objective.items()],
        right=(1,),
    )
    for text in [*_advice(outcome.prior_data_advice), *_undamped(outcome.undamped_tyres), *_held(outcome.held_masses)]:
        say(text, "advice: ")
    warn(_warnings(outcome))


def _show_parameters(outcome: CalibrationSummary, level: str) -> None:
    given = any(item.interval is None and item.interval_given_pivots is not None for item in outcome.parameters.values())
    columns = ["parameter", "value", "unit", f"{level} interval", "status"]
    if given:
        columns.insert(4, f"if {' and '.join(outcome.pivots)} were known")
    rows = []
    for name, item in outcome.parameters.items():
        row = [name, f"{item.value:.5g}", item.unit, _interval(item.interval), item.status]
        if given:
            row.insert(4, "held" if name in outcome.pivots else _interval(item.interval_given_pivots))
        rows.append(row)
    print_table(f"{outcome.vehicle}: parameters, {outcome.method}", columns, rows, right=(1,))


def _show_runs(outcome: CalibrationSummary) -> None:
    steps = {item.step for item in outcome.conditions}
    rows: list[tuple[str, ...]] = []
    for run, items in groupby(sorted(outcome.conditions, key=lambda item: item.run), key=lambda item: item.run):
        every = list(items)
        told = [item for item in every if item.name in NEVER_LEFT_OUT or abs(item.sigmas) >= LITTLE_OFF_SIGMAS]
        own = []
        for item in told:
            what = f"{item.name}, {item.step}" if len(steps) > 1 else item.name
            what += "" if item.place == "run" else f" of {item.place}"
            own.append((what, _size(item, item.value, "+"), _size(item, item.prior), f"{item.sigmas:+.2f}"))
        if len(told) < len(every):
            own.append((f"{len(every) - len(told)} {'others' if told else 'errors'}", "", "", "within 1"))
        chi2 = f"{outcome.run_chi2[run]:.3f}" if run in outcome.run_chi2 else ""
        rows += [(run, chi2, *row) if number == 0 else ("", "", *row) for number, row in enumerate(own)]
    if rows:
        columns = ("run", "chi2", "fitted along", "off what the run file states", "known to", "sigmas")
        print_table("runs, as the fit found them", columns, rows, right=(1, 3, 4, 5))


def _size(item: ConditionSummary, value: float, sign: str = "") -> str:
    """Return a condition's size, a relative one in percent."""
    return f"{100 * value:{sign}.2f} %" if not item.unit else f"{value:{sign}.4f} {item.unit}"


def _interval(interval: tuple[float, float] | None) -> str:
    return "" if interval is None else interval_words(interval)


def _to_three_decimals(interval: tuple[float, float] | None) -> str:
    return "" if interval is None else f"{interval[0]:.3f} to {interval[1]:.3f}"


def _listed(names: list[str]) -> str:
    return ", ".join(names[:MOST_NAMES]) + (" ..." if len(names) > MOST_NAMES else "")


def _far_off(outcome: CalibrationSummary) -> list[str]:
    """Say of each run what its fit supposes far off what was known of it, the farthest of a name, and which way."""
    runs: dict[str, dict[str, ConditionSummary]] = {}
    for item in sorted(outcome.conditions, key=lambda item: abs(item.sigmas)):
        if abs(item.sigmas) > FAR_OFF_SIGMAS:
            runs.setdefault(item.run, {})[item.name] = item
    found = []
    for run, own in runs.items():
        sizes = {name: f"{item.value:+.3g} {item.unit}" if item.unit else f"{item.value:+.1%}" for name, item in reversed(own.items())}
        parts = ", ".join(f"{name} ({size}, {abs(own[name].sigmas):.1f} standard deviations)" for name, size in sizes.items())
        found.append(f"{run}: fitted far off what was known of it: {parts}; look at the run")
    return found


def _unexplained(outcome: CalibrationSummary) -> list[str]:
    """Say what the fit does not explain: what it leaves may pass for noise or roughness, and chi2 then shows nothing."""
    from vehgen.road.iso8608 import CLASSES

    apart = {name: area for name, area in outcome.objective.items() if area > UNEXPLAINED_AREA}
    found, roughest = [], CLASSES[ROUGHEST_ROAD][2]
    if apart:
        told = _listed([f"{name} ({area:.2f})" for name, area in sorted(apart.items(), key=lambda item: -item[1])])
        found.append(f"not explained by the fit, by the area between the PSDs: {told}; {PASSED_FOR_NOISE}")
    for item in outcome.noise:
        if (level := sorted(item.road_level_m3)[len(item.road_level_m3) // 2]) > roughest:
            found.append(
                f"{item.run}: its road was taken to be rougher than class {ROUGHEST_ROAD} beside what the run file states "
                f"({level:.1g} m^3); {PASSED_FOR_NOISE}"
            )
    return found


def _warnings(outcome: CalibrationSummary) -> list[str]:
    found = list(dict.fromkeys(item.told for item in outcome.recorder))
    rank, searched = outcome.rank, outcome.searched
    if any(item.status == "unidentifiable" for item in outcome.parameters.values()):
        moved = "; ".join(_listed(list(direction)) for direction in outcome.null_directions)
        found.append(
            f"recordings of these sensors can determine {rank} combinations of the {searched} parameters, whatever the run (what can "
            f"change together: {moved}); of the sets that fit alike this is the one nearest to the vehicle file's values"
        )
    bound = [name for name, item in outcome.parameters.items() if item.status == "bound"]
    if bound:
        found.append(f"set by the search range, not by the data: {', '.join(bound)}")
    found += _unexplained(outcome)
    found += _far_off(outcome)
    found += [
        f"the tyre of {name} would have left the road (its load falls to {share:.2f} of the static load): the linear tyre does not hold"
        for name, share in outcome.tyre_load_minimum.items()
        if share < 0
    ]
    worst = max([outcome.chi2 or 0.0, *outcome.run_chi2.values()])
    if worst > MAX_CHI2:
        found.append(
            f"the residuals are larger than the noise model allows (chi2 {worst:.2f}): all intervals are wider by the factor "
            f"{outcome.interval_inflation:.2f}; `diagnose` looks for what is missing"
        )
    return found


def _advice(advice: tuple[FactAdvice, ...]) -> list[str]:
    """Say which fact would help most, and which beside it."""
    if not advice or advice[0].width_left > WORTH_ASKING:
        return []
    best = advice[0]
    halved = f" (narrower by half: {_listed(list(best.narrows))})" if best.narrows else ""
    found = [
        f"what would help most is the {_named(best)}: intervals would keep {100 * best.width_left:.0f} % of their width on "
        f"average{halved}; write `{_entry(best)}` into a file and give it with --facts"
    ]
    second = min(advice, key=lambda item: item.width_left_beside_best)
    if second is not best and second.width_left_beside_best < WORTH_ASKING * best.width_left:
        found.append(f"then the {_named(second)}, which would leave {100 * second.width_left_beside_best:.0f} %: `{_entry(second)}`")
    return found


def _named(item: FactAdvice) -> str:
    return f"{item.fact}, known to {_rounded(item)}"


def _entry(item: FactAdvice) -> str:
    return item.entry.replace("...", f"{{value: ... {item.unit}, uncertainty: {_rounded(item)}}}")


def _rounded(item: FactAdvice) -> str:
    """Return how well a fact would be known, in two digits."""
    return f"{float(f'{item.uncertainty:.2g}'):g} {item.unit}"


def _undamped(axles: tuple[str, ...]) -> list[str]:
    """Say what tyres without damping make of the masses of their axles."""
    if not axles:
        return []
    return [
        f"the file gives no damping to the tyres of {_listed(list(axles))}: what real ones damp passes for lighter axles on softer tyres, "
        "and no interval knows of it; give these tyres a `c` with a range to see by how much"
    ]


def _held(masses: HeldMasses | None) -> list[str]:
    """Say what hangs on masses that the vehicle file takes as known."""
    if masses is None:
        return []
    names = " and ".join(masses.names)
    follows = [f"{name} by {share:+.1f} %" for name, share in masses.follows.items()]
    alike = all(abs(share - 1) < EVENLY for share in masses.follows.values())
    told = f"{_listed(list(masses.follows))} 1 % larger" if alike else f"other parameters: {_listed(follows)}"
    return [
        f"the file gives {names} no range, and these recordings tell the rest only over {names}: 1 % more would make {told}, and no "
        f"interval knows of it; where {names} is not known so well, give a range, and state with --facts what was weighed"
    ]
