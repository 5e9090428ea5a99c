"""Words for what a diagnosis speaks of: an effect with its strength, a place, a share, names in a row."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from vehgen.diagnose.fits.candidate import Candidate
from vehgen.diagnose.verdict import NamedParameter
from vehgen.effects.places import ALIKE, ALL_RUNS, ALL_SUSPENSIONS, ALL_TYRES, EACH_TYRE
from vehgen.vehicle import Vehicle

SHARE_CALLED_ALL = 0.995
"""A share from which on the text says "all"."""
_AT = {
    "suspension": "in the {} suspension",
    "tyre": "in the {} tyre",
    "hinge": "in the hinge {}",
    "body": "on the body {}",
    "link": "in the link {}",
}
"""Where an effect is, by what it lives at."""


def join_names(items: Sequence[str], word: str = "or") -> str:
    """Return names joined as in a sentence, the last by a word."""
    listed = list(items)
    return listed[0] if len(listed) == 1 else f"{', '.join(listed[:-1])} {word} {listed[-1]}" if listed else "nothing"


def place_words(attaches: str, place: str) -> str:
    """Return where an effect is, in words: of an effect that lives at `attaches` (suspension, tyre, hinge, body, axles, sensor, run)."""
    if place == ALL_TYRES:
        return "in all tyres"
    if place == EACH_TYRE:
        return "in all tyres, of each its own"
    if place == ALL_SUSPENSIONS:
        return "in all suspensions, alike"
    if ALIKE in place:
        return f"in the suspensions of {join_names(place.split(ALIKE), 'and')}, alike"
    if place == ALL_RUNS:
        return "in all runs"
    if attaches == "axles":
        return f"at the axles {join_names(place.split('+'), 'and')}"
    return _AT.get(attaches, "at {}").format(place)


def effect_words(title: str, where: str, parameters: Mapping[str, NamedParameter]) -> str:
    """Return an effect with its strength and its place: "Dry friction of about 446 N in the rear suspension".

    Parameters
    ----------
    title
        Its title; what stands in brackets is left out.
    where
        Its place in words, of :func:`place_words`.
    parameters
        Its parameters; more than one are listed by name.
    """
    told = [(name, f"{amount(item.value)} {item.unit}".strip()) for name, item in parameters.items()]
    strength = f" of about {told[0][1]}" if len(told) == 1 else ""
    listed = f" ({', '.join(f'{name} {value}' for name, value in told)})" if len(told) > 1 else ""
    return f"{title.partition(' (')[0]}{strength} {where}{listed}"


def candidate_words(vehicle: Vehicle, candidate: Candidate, parameters: Mapping[str, NamedParameter] | None = None) -> str:
    """Return an effect at its place of a vehicle in words, with its strength where its parameters are known."""
    effect = candidate.effect
    attaches = "link" if candidate.place in vehicle.links else effect.attaches
    return effect_words(effect.title, place_words(attaches, candidate.place), parameters or {})


def amount(value: float) -> str:
    """Return a number with three digits that count."""
    return f"{value:.3g}" if not 999.5 <= abs(value) < 1e6 else f"{float(f'{value:.3g}'):.0f}"


def share_words(share: float) -> str:
    """Return a share of what the model missed: all, a percentage, or none, also where a law makes it worse."""
    if share <= 1 - SHARE_CALLED_ALL:
        return "none"
    return "all" if share >= SHARE_CALLED_ALL else f"{100 * share:.0f} %"


def force_words(kind: str, name: str) -> str:
    """Return what would explain the gap where the place test passes: an unknown force there, or a channel or sensor left out."""
    if kind in ("channel", "sensor"):
        return f"leaving out the {kind} {name}"
    return f"an unknown force {place_words(kind, name)}"


def inner(phrase: str) -> str:
    """Return a phrase as it stands within a sentence; what begins with two capitals is a name."""
    return phrase if phrase[1:2].isupper() else phrase[:1].lower() + phrase[1:]
