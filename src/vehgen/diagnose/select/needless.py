"""Leaves out an effect that was found first and stood in for a later one, which does as well without it.

Of several effects the first is chosen while the others are missing, and the base parameters have bent to that. One that was left out of the
first round, or whose fit ended in a wrong minimum there, may explain everything alone once it is fitted from where it stands beside others.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from vehgen.diagnose.detect.detection import Detection
from vehgen.diagnose.fits.model_fit import ModelFit
from vehgen.diagnose.select.alternatives import refit_later
from vehgen.diagnose.select.criteria import excess, passes
from vehgen.diagnose.select.ranking import SearchRound, does_as_well, merit


def without_needless(chain: Sequence[ModelFit], detection: Detection, rounds: list[SearchRound]) -> list[ModelFit]:
    """Return a chain of fits, each of one more effect, without the effects that its later ones do as well without.

    Parameters
    ----------
    chain
        The fits, the first of one effect beside the base.
    detection
        What was detected.
    rounds
        The rounds so far; fits that are made here are put into the round of the model that they were added to.
    """
    base = detection.base
    for number in range(len(chain) - 1):
        current = chain[number - 1] if number else base
        shorter = refit_later(detection, current, chain[-1].effects[number + 1 :], chain[-1], checked=True)
        if shorter and passes(shorter[-1], base) and _does_as_well(shorter[-1], chain[-1], current):
            for fit, before in zip(shorter, [current, *shorter], strict=False):
                _put(rounds, before, fit)
            return without_needless([*chain[:number], *shorter], detection, rounds)
    return list(chain)


def _does_as_well(shorter: ModelFit, whole: ModelFit, before: ModelFit) -> bool:
    """Return whether a fit leaves as little as one with an effect more, on the training runs and on validation runs."""
    return does_as_well(shorter.training, whole.training, excess(before.training)) and (
        not np.isfinite(whole.validation) or does_as_well(shorter.validation, whole.validation, excess(before.validation))
    )


def _put(rounds: list[SearchRound], current: ModelFit, fit: ModelFit) -> None:
    """Put a fit into the round of the model that it was added to, in place of a worse one of the same effect."""
    for number, known in enumerate(rounds):
        if known.current.key == current.key:
            others = [item for item in known.fits if item.key != fit.key]
            rounds[number] = replace(known, fits=tuple(sorted([fit, *others], key=merit)))
            return
    rounds.append(SearchRound(current, (), (), (fit,)))
