"""Distinct faults of a fuzzing run, each kept once, with the smallest files that show it."""

from __future__ import annotations

import shutil
from collections import Counter
from dataclasses import dataclass, replace
from pathlib import Path

from tests.fuzzing.cases import Case
from tests.fuzzing.judge import FAULT, Answer, Verdict


@dataclass(frozen=True)
class Costs:
    """The most CPU time [s] and memory beyond the imports [MB] of the files of one format, and the numbers of their cases."""

    seconds: float = 0.0
    slowest: int = -1
    megabytes: float = 0.0
    largest: int = -1

    def with_answer(self, number: int, answer: Answer) -> Costs:
        """Return the costs with one more answer counted."""
        found = self
        if answer.seconds > found.seconds:
            found = replace(found, seconds=answer.seconds, slowest=number)
        if answer.megabytes > found.megabytes:
            found = replace(found, megabytes=answer.megabytes, largest=number)
        return found


class Faults:
    """Outcomes by format, and each distinct fault with its smallest case."""

    def __init__(self) -> None:
        self.outcomes: Counter[tuple[str, str]] = Counter()
        self.counts: Counter[tuple[str, str]] = Counter()
        self.smallest: dict[tuple[str, str], tuple[int, Case, Verdict]] = {}
        self.costs: dict[str, Costs] = {}

    def add(self, number: int, case: Case, verdict: Verdict) -> None:
        """Count a verdict; keep its case where it is the smallest that shows its fault."""
        self.outcomes[case.format, verdict.outcome] += 1
        if not verdict.compiles:
            self.costs[case.format] = self.costs.get(case.format, Costs()).with_answer(number, verdict.answer)
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
            if not any((place / "out").iterdir()):
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
        """Return a table of outcomes by format, with the most CPU time and memory of a file that no compiler saw."""
        kinds = ("accepted", "refused", FAULT)
        lines = [f"{'format':<10}" + "".join(f"{kind:>10}" for kind in kinds) + f"{'most time':>26}{'most memory':>26}"]
        for name in sorted({key[0] for key in self.outcomes}):
            costs = self.costs.get(name, Costs())
            lines.append(
                f"{name:<10}"
                + "".join(f"{self.outcomes[name, kind]:>10}" for kind in kinds)
                + f"{costs.seconds:>8.2f} s (case {costs.slowest:>6d})"
                + f"{costs.megabytes:>7.0f} MB (case {costs.largest:>6d})"
            )
        return "\n".join(lines)


def size(case: Case) -> int:
    """Return how much there is to read in a case [bytes]."""
    return sum(len(data) for data in case.files.values())
