"""Markdown tables of scored cases."""

from __future__ import annotations

import json
import statistics
from collections import Counter
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from scipy import stats

from benchmarks.measured_world.solve import BANDS

Data = dict[str, Any]
LEVEL = 0.90
"""Of the intervals."""
TITLES = {
    "healthy": "Nothing hidden",
    "effects": "One effect hidden",
    "faults": "A mistake of measuring",
    "rigs": "Test rigs",
    "coverage": "Calibrations",
}


def read(paths: Iterable[Path]) -> list[Data]:
    """Return the records of files of JSON lines."""
    return [json.loads(line) for path in paths for line in path.read_text(encoding="utf-8").splitlines()]


def page(records: Sequence[Data]) -> str:
    """Return the tables of all kinds that occur."""
    parts = []
    for kind, title in TITLES.items():
        of_kind = [record for record in records if record["kind"] == kind]
        if of_kind:
            parts.append(f"## {title}: {len(of_kind)} cases")
            parts += coverage_tables(of_kind) if kind == "coverage" else [verdict_table(of_kind), case_table(of_kind)]
            told = [row for record in of_kind if kind == "rigs" for row in record["rows"]]
            parts += [interval_table(told)] if told else []
            parts.append(seconds_table(of_kind))
    return "\n\n".join(parts) + "\n"


def table(header: Sequence[str], rows: Iterable[Sequence[object]]) -> str:
    """Return a Markdown table."""
    lines = [header, ["---"] * len(header), *([str(cell) for cell in row] for row in rows)]
    return "\n".join(f"| {' | '.join(line)} |" for line in lines)


def groups(records: Sequence[Data]) -> dict[str, list[Data]]:
    """Return records by vehicle and recorder, and all of them."""
    found: dict[str, list[Data]] = {}
    for record in records:
        found.setdefault(f"{record['vehicle']}, {record['recorder']}", []).append(record)
    return {**dict(sorted(found.items())), "all": list(records)}


def verdict_table(records: Sequence[Data]) -> str:
    """Return how often every judgement was met, by vehicle and recorder."""
    by_group = {name: Counter(record["judged"] for record in items) for name, items in groups(records).items()}
    judgements = [name for name, _ in by_group["all"].most_common()]
    return table(("outcome", *by_group), ([name, *(counts[name] for counts in by_group.values())] for name in judgements))


def case_table(records: Sequence[Data]) -> str:
    """Return one line for every case with something hidden or wrong, or with more than nothing named."""
    lines = []
    for record in sorted(records, key=lambda item: str(item["case"])):
        hidden = ", ".join(f"{effect['name']} at {effect['place']}" for effect in record["effects"])
        if record["fault"]:
            hidden = f"{record['fault']['kind']} {', '.join(record['fault']['items'])}"
        answer = record["answer"]
        told = ", ".join(f"{effect['name']} at {effect['place']}" for effect in answer.get("effects", []))
        told = ", ".join([told] * bool(told) + [str(item.get("kind")) for item in answer.get("faults", [])])
        gap = answer.get("gap") or {}
        chi = "-" if gap.get("before") is None else f"{gap['before']:.2f}"
        lines.append((record["case"], record["vehicle"], record["recorder"], hidden or "-", record["judged"], told or "-", chi))
    return table(("case", "vehicle", "recorder", "truth", "outcome", "told", "chi before"), lines)


def coverage_tables(records: Sequence[Data]) -> list[str]:
    """Return outcomes, the intervals' coverage, and errors on unseen roads."""
    outcomes = Counter(record["answer"]["outcome"] for record in records)
    parts = [table(("outcome", "cases"), outcomes.most_common())]
    for name, items in groups(records).items():
        rows = [row for record in items for row in record["rows"]]
        if rows and name != "all":
            parts.append(f"### {name}\n\n{interval_table(rows)}")
        bands = band_table(items)
        if bands and name != "all":
            parts.append(bands)
    return parts


def interval_table(rows: Sequence[Data]) -> str:
    """Return by family how many intervals hold the truth, how wide they are, and how large the errors are."""
    families = dict.fromkeys(row["family"] for row in rows)
    lines = []
    for family in (*families, "all"):
        part = [row for row in rows if family in (row["family"], "all")]
        known = [row for row in part if row["low"] is not None and row["value"] is not None]
        inside = sum(row["low"] <= row["truth"] <= row["high"] for row in known)
        errors = [row["value"] / row["truth"] - 1.0 for row in part if row["value"] is not None]
        widths = [0.5 * (row["high"] - row["low"]) / row["truth"] for row in known]
        score = [abs(row["value"] - row["truth"]) / (0.5 * (row["high"] - row["low"])) for row in known if row["high"] > row["low"]]
        low, high = _binomial(inside, len(known))
        lines.append(
            (
                family,
                len(part),
                len(part) - len(known),
                f"{100 * inside / max(len(known), 1):.0f} ({100 * low:.0f} to {100 * high:.0f})",
                f"{100 * _median(widths):.2f}",
                f"{100 * float(np.sqrt(np.mean(np.square(errors)))):.2f}" if errors else "-",
                f"{_median(score):.2f}",
            )
        )
    header = ("family", "quantities", "without interval", "hold the truth [%] (95 % of chance)", "half width, median [%]")
    return table((*header, "rms error [%]", "error over half width, median"), lines)


def _binomial(hits: int, count: int) -> tuple[float, float]:
    """Return the Clopper-Pearson interval of a share, 95 %, as if all were independent."""
    low = float(stats.beta.ppf(0.025, hits, count - hits + 1)) if hits else 0.0
    high = float(stats.beta.ppf(0.975, hits + 1, count - hits)) if hits < count else 1.0
    return low, high


def band_table(records: Sequence[Data]) -> str:
    """Return the errors of the band rms on unseen roads, by quantity; an empty text where there are none."""
    errors: dict[tuple[str, int], list[float]] = {}
    for record in records:
        for channels in record["answer"].get("unseen", {}).values():
            for channel, values in channels.items():
                for i, value in enumerate(values):
                    errors.setdefault((channel.rsplit("_", 1)[1], i), []).append(abs(value))
    if not errors:
        return ""
    names = {"az": "acceleration", "q": "pitch rate"}
    lines = []
    for quantity in ("az", "q"):
        cells = [errors.get((quantity, i), []) for i in range(len(BANDS))]
        lines.append((names[quantity], *(f"{100 * _median(cell):.1f} ({100 * max(cell, default=float('nan')):.0f})" for cell in cells)))
    return table(("band rms on unseen roads: median error [%] (largest)", *(f"{low:g} to {high:g} Hz" for low, high in BANDS)), lines)


def seconds_table(records: Sequence[Data]) -> str:
    """Return how long the cases took, by vehicle and recorder."""
    lines = []
    for name, items in groups(records).items():
        wall = [item["answer"]["seconds"] for item in items if "seconds" in item["answer"]]
        cpu = [item["answer"]["cpu_seconds"] for item in items if "cpu_seconds" in item["answer"]]
        lines.append((name, len(items), f"{_median(wall):.0f}", f"{max(wall, default=float('nan')):.0f}", f"{_median(cpu):.0f}"))
    return table(("", "cases", "seconds, median", "longest", "CPU seconds, median"), lines)


def _median(values: Sequence[float]) -> float:
    return statistics.median(values) if values else float("nan")
