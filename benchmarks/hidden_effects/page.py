"""Write the tables of docs/hidden-effects.md and its figure from a set's results: `python -m benchmarks.hidden_effects.page RESULTS.jsonl`.

What stands outside the two marks of the page is written by hand and kept.
"""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.figure import Figure

from benchmarks.hidden_effects.score import NAMED, needless, right_name, right_place, score, table, untouched
from vehgen.effects import EFFECTS
from vehgen.report import save_figure

ROOT = Path(__file__).resolve().parents[2]
PAGE = ROOT / "docs" / "hidden-effects.md"
IMAGE = ROOT / "docs" / "images" / "hidden-effects.svg"
START, END = "<!-- results: start -->", "<!-- results: end -->"
OTHER = ("no_missing_effect", "too_weak", "not_in_library", "insufficient_data", "measurement_fault", "crash")


def main() -> None:
    """Rewrite the page."""
    records = [json.loads(line) for line in Path(sys.argv[1]).read_text(encoding="utf-8").splitlines()]
    order = {name: i for i, name in enumerate(EFFECTS)}
    kinds = ("listed", "two", "weak", "outside", "null")
    records.sort(key=lambda item: (kinds.index(item["kind"]), item["vehicle"], order.get(_first(item), 99), item["case"]))
    text = PAGE.read_text(encoding="utf-8")
    head, rest = text.split(START)[0], text.split(END)[1]
    body = [START, "", table(score(records)), "", "![Which effect was hidden, and what was said](images/hidden-effects.svg)", ""]
    body += ["| case | hidden | said | chi before | chi after | validation | s | |", "|---|---|---|---|---|---|---|---|"]
    body += [_row(item) for item in records]
    PAGE.write_text(head + "\n".join([*body, "", END]) + rest, encoding="utf-8")
    save_figure(_matrix(records), IMAGE)


def _first(item: dict[str, Any]) -> str:
    return str(item["truth"][0]["name"]) if item["truth"] else ""


def _row(item: dict[str, Any]) -> str:
    hidden = ", ".join(f"{effect['name']} at {effect['place']}" for effect in item["truth"]) or "nothing"
    named = ", ".join(f"{effect['name']} at {effect['place']}" for effect in item.get("effects", []))
    said = f"{item['verdict']}: {named}" if named else item["verdict"]
    gap = item.get("gap", {"before": float("nan"), "after": float("nan"), "runs": []})
    return (
        f"| {item['case']} | {hidden} | {said} | {gap['before']:.2f} | {gap['after']:.2f} | {untouched({'gap': gap}):.2f} "
        f"| {item['seconds']:.0f} | {_mark(item)} |"
    )


def _mark(item: dict[str, Any]) -> str:
    kind, verdict = item["kind"], item["verdict"]
    if kind == "null":
        return "right" if verdict not in NAMED else "**false alarm**"
    if kind == "outside":
        return "right" if verdict == "not_in_library" else "**wrong**" if verdict in NAMED else "missed"
    if kind == "two":
        found = sum(right_name(item, i) for i in (0, 1))
        return ("**missed**", "one of two", "right")[found]
    if kind == "weak":
        return "right" if verdict not in NAMED or right_name(item) else "**wrong**"
    if needless(item):
        return "**a needless second one**"
    if right_name(item):
        return "right" if right_place(item) else "right, **elsewhere**"
    return "**wrong**" if verdict in NAMED else "**missed**"


def _matrix(records: list[dict[str, Any]]) -> Figure:
    single = [item for item in records if item["kind"] in ("listed", "weak", "outside", "null")]
    rows = [*(name for name in EFFECTS if any(_truth(item) == name for item in single)), "too weak", "outside the library", "nothing"]
    columns = [*(name for name in EFFECTS if any(name in _said(item) for item in single)), *OTHER]
    columns = [name for name in columns if any(name in _said(item) for item in single)]
    counts = np.zeros((len(rows), len(columns)))
    for item in single:
        for name in _said(item):
            counts[rows.index(_truth(item)), columns.index(name)] += 1 / len(_said(item))
    figure = Figure(figsize=(9.5, 8.0), layout="constrained")
    axes = figure.subplots()
    axes.imshow(np.minimum(counts, 4), cmap="Blues", vmin=0, vmax=5, aspect="auto")
    for i, j in zip(*np.nonzero(counts), strict=True):
        axes.text(j, i, f"{counts[i, j]:.3g}", ha="center", va="center", fontsize=8, color="white" if counts[i, j] > 3 else "#1b2733")
    axes.set_xticks(range(len(columns)), [name.replace("_", " ") for name in columns], rotation=60, ha="right", fontsize=8)
    axes.set_yticks(range(len(rows)), [name.replace("_", " ") for name in rows], fontsize=8)
    axes.set_xticks(np.arange(len(columns) + 1) - 0.5, minor=True)
    axes.set_yticks(np.arange(len(rows) + 1) - 0.5, minor=True)
    axes.grid(which="minor", color="#e3e7ea", lw=0.6)
    axes.tick_params(which="both", length=0)
    axes.set_xlabel("said (a tie counts in parts)")
    axes.set_ylabel("hidden")
    return figure


def _truth(item: dict[str, Any]) -> str:
    return {"weak": "too weak", "outside": "outside the library", "null": "nothing"}.get(item["kind"], _first(item))


def _said(item: dict[str, Any]) -> list[str]:
    named = list(dict.fromkeys(effect["name"] for effect in item.get("effects", [])))
    return named if item["verdict"] in NAMED else [item["verdict"]]


if __name__ == "__main__":
    main()
