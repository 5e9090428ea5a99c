"""Distinct faults of a fuzzing run, each kept once, with the smallest files that show it."""

from __future__ import annotations

import shutil
from collections import Counter
from pathlib import Path

from tests.fuzzing.cases import Case
from tests.fuzzing.judge import FAULT, Verdict


class Faults:
    """Outcomes by format, and each distinct fault with its smallest case."""

    def __init__(self) -> None:
        self.outcomes: Counter[tuple[str, str]] = Counter()
        self.counts: Counter[tuple[str, str]] = Counter()
        self.smallest: dict[tuple[str, str], tuple[int, Case, Verdict]] = {}

    def add(self, number: int, case: Case, verdict: Verdict) -> None:
        """Count a verdict; keep its case where it is the smallest that shows its fault."""
        self.outcomes[case.format, verdict.outcome] += 1
        if verdict.outcome != FAULT:
            return
        key = (case.format, verdict.signature)
        self.counts[key] += 1
        if key not in self.smallest or size(case) < size(self.smallest[key][1]):
            self.smallest[key] = (number, case, verdict)

    def write(self, folder: Path) -> None:
        """Write every distinct fault's case into a folder of its own below `folder`: its files, `case.json` and `verdict.txt`."""
        for i, (key, (number, case, verdict)) in enumerate(sorted(self.smallest.items()), 1):
            place = folder / f"{key[0]}-{i:03d}"
            shutil.rmtree(place, ignore_errors=True)
            case.write(place)
            (place / "out").rmdir()
            (place / "case.json").write_text(case.describe(), encoding="utf-8")
            lines = [
                f"case {number}, seen {self.counts[key]} times",
                *verdict.reasons,
                "",
                str(verdict.answer.message),
                "",
                verdict.answer.crash,
            ]
            (place / "verdict.txt").write_text("\n".join(lines), encoding="utf-8", errors="backslashreplace")

    def list(self) -> str:
        """Return one line a distinct fault: how often, the format, what it is."""
        keys = sorted(self.counts, key=lambda key: (key[0], -self.counts[key]))
        lines = [f"{self.counts[key]:6d}  {key[0]:<8} case {self.smallest[key][0]:<6d} {key[1]}" for key in keys]
        return "\n".join(lines).encode("utf-8", "backslashreplace").decode()

    def table(self) -> str:
        """Return a table of outcomes by format."""
        kinds = ("accepted", "refused", FAULT)
        lines = [f"{'format':<10}" + "".join(f"{kind:>10}" for kind in kinds)]
        lines += [
            f"{name:<10}" + "".join(f"{self.outcomes[name, kind]:>10}" for kind in kinds)
            for name in sorted({key[0] for key in self.outcomes})
        ]
        return "\n".join(lines)


def size(case: Case) -> int:
    """Return how much there is to read in a case [bytes]."""
    return sum(len(data) for data in case.files.values())
