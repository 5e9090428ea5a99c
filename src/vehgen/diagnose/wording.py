"""What a diagnosis says, in sentences that an engineer understands at first reading; all verdicts are worded here."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import pairwise

from vehgen.diagnose.detect.odd_run import OddRun
from vehgen.diagnose.phrases import inner, join_names, share_words
from vehgen.fit.nuisances import Condition

MOST_TOLD = 4
"""So many effects that do as well as one another are told in words, and how many more there are."""
UNSEEN_RUNS = "on runs that it was not fitted to"


def named(effects: Sequence[str], gain: float | None, ties: Sequence[str] = ()) -> str:
    """Return the verdict `named`, or `ambiguous` where other effects do as well as one of several.

    Parameters
    ----------
    effects
        What was found, of `phrases.effect_words`.
    gain
        The share of the excess on validation runs that they close together; None where these show no gap.
    ties
        Other effects that do as well as one of them.
    """
    several = len(effects) > 1
    who = "together they explain" if several else "it explains"
    fitted = UNSEEN_RUNS.replace("it was", "they were") if several else UNSEEN_RUNS
    what = "what the model missed on the runs for fitting; the other runs show no gap" if gain is None else ""
    what = what or f"{share_words(gain or 0.0)} of what the model missed {fitted}"
    more = f"; {join_names([*map(inner, ties)])} would do as well as one of these" if ties else ""
    return f"{join_names([effects[0], *map(inner, effects[1:])], 'and')}: {who} {what}{more}"


def several_effects(effects: Sequence[str], left: Sequence[float], gain: float | None) -> str:
    """Return the verdict `several_effects`.

    Parameters
    ----------
    effects
        What was found, of `phrases.effect_words`, each beside those before it.
    left
        The chi of the base, then what each effect leaves.
    gain
        The share of the excess on validation runs that they close together; None where these show no gap.
    """
    steps = [f"{before:.3g} to {after:.3g}" for before, after in pairwise(left)]
    told = [f"{inner(text) if i else text} ({step})" for i, (text, step) in enumerate(zip(effects, steps, strict=True))]
    what = "what the model missed on the runs for fitting" if gain is None else ""
    what = what or f"{share_words(gain or 0.0)} of what the model missed {UNSEEN_RUNS.replace('it was', 'they were')}"
    return f"{join_names(told, 'and')}, in brackets the chi before and after each: together they explain {what}, none does alone"


ONE_AT_A_TIME = "runs that move one part at a time (one axle, slow and fast, small and large) tell whether each of these is there"
"""What to do where only several effects together explain the recordings."""


def ranked(effects: Sequence[tuple[str, float]]) -> str:
    """Return the note of effects that come nearest, with the share of the gap that each would close."""
    told = join_names([f"{inner(text) if i else text} {max(100 * share, 0):.0f} %" for i, (text, share) in enumerate(effects)], "and")
    return f"by the share of the gap that each would close alone: {told}"


def ambiguous(effects: Sequence[str]) -> str:
    """Return the verdict `ambiguous` between effects, of `phrases.effect_words`, each of which explains the runs by itself."""
    told = [effects[0], *map(inner, effects[1:])]
    if len(told) > MOST_TOLD + 1:
        told[MOST_TOLD:] = [f"one of {len(told) - MOST_TOLD} others"]
    return f"{join_names(told)}: each explains the runs equally well"


def no_missing_effect(chi: float) -> str:
    """Return the verdict that the recalibrated model leaves no more than noise."""
    return f"Nothing is missing: what the recalibrated model leaves is noise (chi {chi:.3f}, where 1 is noise alone)"


def not_in_library(best: tuple[int, str, float] | None, causes: Sequence[str], freed: Sequence[str] = ()) -> str:
    """Return the verdict that no effect of the library explains the gap.

    Parameters
    ----------
    best
        How many effects were tried, which of them leaves least, and the chi that it leaves; None where none is left.
    causes, freed
        What would explain the gap, of `phrases.force_words`; base parameters of which other values do as much as any effect does.
    """
    does_no_more = f"does more than other values of {join_names(freed)} do"
    tried = f"none of those tried {does_no_more if freed else 'can live where the model errs'}"
    if best is not None:
        count, label, chi = best
        tried = f"of {count} tried, {label} comes nearest and leaves chi {chi:.2f}, where 1 is noise alone"
    where = f"{join_names(causes)} would" if causes else "an unknown force at a single place would not either"
    return f"No effect of the library explains what the model misses ({tried}); {where}"


def imitates(label: str, apart: Sequence[str], ends: Sequence[str] = (), left: float | None = None) -> str:
    """Return the verdict that an effect closes the gap, but with numbers `apart` from run to run, or at `ends` of ranges with chi left."""
    doubt = "other runs do not surely show half of it" if left is None else f"chi {left:.2f} is left, where 1 is noise alone"
    why = f"runs ask for numbers of it that exclude one another ({join_names(apart)})"
    why = why if apart else f"only with {join_names(ends, 'and')} at the end of its range, and {doubt}"
    return f"{label} imitates what the model misses, but {why}: what acts there is not in the library"


def not_told_from_chance(chi: float, p_value: float) -> str:
    """Return the verdict `too_weak` where the best effect may be chance."""
    gap = f"a gap is there (chi {chi:.3f}, where 1 is noise alone)"
    return f"Too weak to name: {gap}, but chance could do what the best effect does (p-value {p_value:.2g})"


def small_gap(chi: float) -> str:
    """Return the verdict `too_weak` where no effect closes enough of a small gap."""
    return f"Too weak to name: a small gap is there (chi {chi:.3f}, where 1 is noise alone), and no effect closes enough of it"


def odd_run(found: OddRun) -> str:
    """Return what is told where one run does not agree with the others on the vehicle, though little seems to be missing."""
    return (
        f"The runs do not agree on the vehicle: with parameters of its own {found.run} would leave {found.gain:.0f} less in squares, where "
        f"chance takes about {found.by_chance:.0f}. Another load or vehicle made that run, or an effect grows with height or speed; "
        "it is too weak to tell which"
    )


def odd_run_again(found: OddRun) -> str:
    """Return the next experiment where one run does not agree with the others."""
    return f"repeat {found.run} with the load of the other runs, and record humps of heights and speeds between those of the runs"


def not_seen_again(label: str) -> str:
    """Return the verdict `too_weak` where the validation runs do not show the best effect."""
    return f"Too weak to name: {label} suits the runs that it was fitted to, but the other runs do not show it"


def seen_once(label: str, chi: float, runs: Sequence[str]) -> tuple[str, str]:
    """Return the verdict `insufficient_data` where no run is left to check the best effect, and what to record."""
    where = join_names(runs)
    reason = (
        f"A gap is there (chi {chi:.2f}, where 1 is noise alone), and {label} suits it, but only {where} shows it: no other run can check"
    )
    return reason, f"record another run like {runs[0]}"


def like_a_random_law(label: str, own: float, random: float) -> str:
    """Return the verdict `too_weak` where a random law does as well as the best effect; both are shares of the gap that they close."""
    return f"Too weak to name: {label} explains {share_words(own)} of what the model missed, a random law there {share_words(random)}"


def best_random_law(count: int, share: float) -> str:
    """Return the note on what the best of many random laws at an effect's place closes of the gap."""
    return f"the best of {count} random laws at the same place explains {share_words(share)} of what the model missed"


def faint(chi: float, on_training: float, on_validation: float) -> str:
    """Return the note on an effect that is told where chi shows no gap."""
    return (
        f"chi hardly shows a gap ({chi:.3f}, where 1 is noise alone); the effect is told by -2 ln of the likelihood, which falls by "
        f"{on_training:.0f} on the runs for fitting and by {on_validation:.0f} on the others with it"
    )


def a_gap(chi: float) -> str:
    """Return that the base leaves more than noise, within a sentence."""
    return f"a gap is there (chi {chi:.2f}, where 1 is noise alone)"


def no_gap(chi: float) -> str:
    """Return that the base leaves no more than noise of runs that all were fitted, within a sentence."""
    return f"what the recalibrated model leaves is noise (chi {chi:.3f}, where 1 is noise alone), which a fit to so little can make so"


def too_few_runs(found: str, count: int) -> str:
    """Return the verdict `insufficient_data` where no run is left for validation; `found` is what the fit to all of them leaves."""
    return f"The runs cannot tell: {found}, but at least three runs are needed, one of them for checking ({count} given)"


def mistaken(faults: Sequence[str]) -> str:
    """Return the verdict `measurement_fault`, of the messages of what is wrong with the measurement."""
    return f"The measurement is at fault: {'; '.join(faults)}"


def supposed(messages: Sequence[str]) -> str:
    """Return the note on what fits suppose of the measurement beyond belief, where a missing effect may have bent them to it.

    What stands in brackets at the end of several messages alike, such as how many standard deviations they are off, is said once.
    """
    alike: dict[str, list[str]] = {}
    for message in messages:
        what, _, how = message.rpartition(" (") if message.endswith(")") else (message, "", "")
        alike.setdefault(how.removesuffix(")"), []).append(what)
    told = ["; ".join(items) + (f" ({'each ' if len(items) > 1 else ''}{how})" if how else "") for how, items in alike.items()]
    return f"The refit supposes more than can be believed, for want of the effect or because it is so: {'; '.join(told)}"


def at_the_edge(names: Sequence[str], tyres: Sequence[str] = ()) -> str:
    """Return the note on base parameters that the refit leaves at the edge of their bounds; `tyres` are axles whose damping looks so."""
    told = f"the refit, within 35 % of the file's values, ends at its edge for {', '.join(names)}: if they are uncertain, calibrate first"
    if not tyres:
        return told
    return f"{told}; damping in the tyres of {' and '.join(tyres)}, of which the file has none, would look like this, too"


def constant_force(found: Condition) -> str:
    """Return the note on what acts beside a measured force all along."""
    return f"the fit supposes {constant_force_words(found)}"


def constant_force_words(found: Condition) -> str:
    """Return a constant force and what it is beside."""
    return f"a constant force of {found.value:.3g} N beside {found.place}"


def not_told(names: Sequence[str]) -> str:
    """Return the note that runs do not tell how large some numbers of an effect are."""
    are = "is" if len(names) == 1 else "are"
    return f"these runs do not tell how large {join_names(names, 'and')} {are}, as of a stop that none of them meets"


def more_general(effect: str, forces: Sequence[str]) -> str:
    """Return the note that an effect, of `phrases.effect_words`, does as well as the one named, its special case, with `forces` beside."""
    beside = f", with {join_names(forces, 'and')}" if forces else ""
    return f"{inner(effect)}{beside} would do as well; the one with fewer numbers is named"


def out_of_range(ratios: Mapping[str, float]) -> str:
    """Return the verdict `insufficient_data` where base parameters far from the file's values explain the gap as well as an effect.

    Parameters
    ----------
    ratios
        Fitted value over the file's, by parameter.
    """
    told = join_names([f"{name} of {ratio:.2f} times the file's value" for name, ratio in ratios.items()], "and")
    return f"The runs cannot tell before this is put right: {told} explains the gap as well as any effect"


def stopped(count: int, best: tuple[str, float] | None) -> str:
    """Return the verdict of a diagnosis that was stopped by hand: after how many candidates, and which one is best so far, with its chi."""
    done = f"{count} candidates" if count else "no candidate"
    return f"No verdict: stopped by hand after {done}" + (f"; the best so far is {best[0]}, chi {best[1]:.2f}" if best else "")
