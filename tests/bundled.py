"""Bundled vehicles as parameters of tests: a few that differ most, and all others marked thorough."""

from __future__ import annotations

from collections.abc import Iterable

import pytest

FEW = ("drop_test", "sedan2", "tractor5_cab", "truck_walking_beam", "rig", "with_laws")
"""A rig, two axles, five axles on two bodies with a hinge and links, axles that share a beam; and the report's own two."""


def few(names: Iterable[str]) -> list[object]:
    """Return names as parameters, those that are not of FEW marked thorough."""
    return [name if name in FEW else pytest.param(name, marks=pytest.mark.thorough) for name in names]
