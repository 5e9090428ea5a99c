"""The study's tables as Markdown, and its numbers as plain data."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from benchmarks.pages import table
from benchmarks.paper_study.figures import MODES
from benchmarks.paper_study.fits import Fit
from benchmarks.paper_study.judging import Judgement, frequency_errors
from benchmarks.paper_study.printed import Printed
from benchmarks.paper_study.recordings import Rig
from benchmarks.paper_study.sensitivity import KINDS, PLACES, Sensitivities


@dataclass(frozen=True)
class Case:
    """One true vehicle with its fits and their judgements (the truth's own first)."""

    rig: Rig
    truth: dict[str, float]
    fits: Sequence[Fit]
    judged: Sequence[Judgement]

    def scores(self, i: int) -> dict[str, float]:
        """Return the scores of fit `i`, as shares: worst band errors, worst frequency errors, typical error of the invariants."""
        item, sensors = self.judged[i + 1], list(self.rig.validation)
        errors = np.abs(item.band_errors(sensors))
        hertz = {name: abs(value) for name, value in frequency_errors(item, self.judged[0]).items()}
        return {
            "test_place": float(errors[0].max()),
            "all_places": float(errors.max()),
            "body": max(value for name, value in hertz.items() if name.startswith("body")),
            "hop": max(value for name, value in hertz.items() if name.startswith("hop")),
            "invariants": float(np.median(np.abs(list(item.invariants.values())))),
        }


def _percent(value: float) -> str:
    return f"{100 * value:.1f}"


def cost_table(cases: Sequence[Case]) -> str:
    """Return what each method evaluated, the shortest time it took, and where Eq. 5 ended for the first vehicle."""
    rows = []
    for i, fit in enumerate(cases[0].fits):
        search, polish = (min(getattr(case.fits[i], name) for case in cases) for name in ("search_s", "polish_s"))
        times = (f"{search:.1f}", f"{polish:.1f}" if fit.method.polish else "")
        rows.append((fit.method.name, str(fit.method.runs), f"{fit.evaluations:,}", *times, f"{fit.eq5:.3f}", f"{fit.eq5_truth:.3f}"))
    return table(("method", "runs", "evaluations", "search [s]", "polish [s]", "Eq. 5 a channel", "at the truth"), rows)


def frequency_table(case: Case) -> str:
    """Return natural frequencies of the truth, and each method's relative errors."""
    modes = MODES[case.rig.kind]
    rows = [("truth [Hz]", *(f"{case.judged[0].frequencies[mode]:.2f}" for mode in modes))]
    rows += [
        (f"{item.name} [%]", *(f"{100 * frequency_errors(item, case.judged[0])[mode]:+.1f}" for mode in modes)) for item in case.judged[1:]
    ]
    return table(("", *modes.values()), rows)


def band_table(case: Case) -> str:
    """Return relative band-RMS errors on the unseen road, at the paper's place."""
    bands = [f"{low:g}-{high:g} Hz" for low, high in case.judged[0].validation.bands]
    place = next(iter(case.rig.validation))
    rows = [(item.name, *(f"{100 * value:+.1f}" for value in item.band_errors([place])[0])) for item in case.judged[1:]]
    return table(("error [%]", *bands), rows)


def summary_table(cases: Sequence[Case]) -> str:
    """Return median and worst scores over several true vehicles."""
    rows = []
    for i, fit in enumerate(cases[0].fits):
        scores = [case.scores(i) for case in cases]
        cells = [np.array([item[key] for item in scores]) for key in ("test_place", "all_places", "body", "hop", "invariants")]
        rows.append((fit.method.name, *(f"{_percent(float(np.median(cell)))} ({_percent(float(cell.max()))})" for cell in cells)))
    return table(("[%], median (worst)", "band rms, test place", "band rms, all places", "body modes", "hop modes", "invariants"), rows)


def printed_table(kind: str, rows: Sequence[Printed]) -> str:
    """Return what the paper's printed parameters give: frequencies, and the PSD's peaks on a class B road."""
    modes = MODES[kind]
    return table(
        ("printed row", *modes.values(), "PSD peaks, class B [Hz]"),
        [(item.name, *(f"{item.frequencies[mode]:.2f}" for mode in modes), ", ".join(f"{f:.1f}" for f in item.peaks)) for item in rows],
    )


def sensitivity_table(found: Sensitivities) -> str:
    """Return each axle's share of the largest at the same place, and L2' over L2."""
    rows = []
    for place in PLACES:
        rows += [
            (place.replace("near", "'"), title, *(f"{found.share(place, kind, i):.2f}" for i in range(1, 6)))
            for kind, title in KINDS.items()
        ]
    rows += [("L2'/L2", title, *(f"{found.ratio('L2near', 'L2', kind, i):.2f}" for i in range(1, 6))) for kind, title in KINDS.items()]
    return table(("place", "parameter", *(f"axle {i}" for i in range(1, 6))), rows)


def data(cases: Sequence[Case]) -> list[dict[str, Any]]:
    """Return all numbers of one kind's cases for JSON."""
    return [
        {
            "truth": case.truth,
            "frequencies_hz": case.judged[0].frequencies,
            "bands_hz": [list(band) for band in case.judged[0].validation.bands],
            "methods": {
                fit.method.name: {
                    "values": fit.values,
                    "search_s": round(fit.search_s, 2),
                    "polish_s": round(fit.polish_s, 2),
                    "evaluations": fit.evaluations,
                    "eq5": fit.eq5,
                    "eq5_at_truth": fit.eq5_truth,
                    "frequencies_hz": item.frequencies,
                    "invariant_errors": item.invariants,
                    "band_errors": {name: item.band_errors([name])[0].tolist() for name in case.rig.validation},
                    **{f"worst_{key}": value for key, value in case.scores(i).items()},
                }
                for i, (fit, item) in enumerate(zip(case.fits, case.judged[1:], strict=True))
            },
        }
        for case in cases
    ]
