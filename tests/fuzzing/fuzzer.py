"""The seeded fuzzer: case number N of a format is the same on every machine."""

from __future__ import annotations

from dataclasses import replace
from random import Random

from tests.fuzzing.bulk_mutations import bulk_entries, bulk_run, bulk_vehicle
from tests.fuzzing.cases import FORMATS, Case, generator
from tests.fuzzing.healthy import healthy
from tests.fuzzing.options import hostile_options
from tests.fuzzing.table_mutations import mutate_export, mutate_table
from tests.fuzzing.text_mutations import TEXT_MUTATIONS
from tests.fuzzing.tree_mutations import mutate_tree, special_file

COMMANDS = {
    "vehicle": (("modes", "MAIN"), ("static", "MAIN", "--json"), ("modes", "MAIN", "--json")),
    "cargo": (("laden", "tractor5", "MAIN", "--out", "out/laden.yaml"),),
    "frame": (("module", "MAIN", "--out", "out/cargo.yaml"),),
    "effects": (("effects", "--library", "MAIN"), ("effects", "--library", "MAIN", "--json")),
}
"""Commands that compile no kernel, by format."""

COMPILING = {
    "vehicle": (("build", "MAIN", "--out", "out/build"),),
    "run": (("simulate", "MAIN", "--out", "out/response.csv", "--plot"), ("simulate", "MAIN", "--out", "out/response.csv", "--json")),
    "table": (("simulate", "MAIN", "--out", "out/response.csv"),),
    "export": (
        (
            *(
                "import",
                "MAIN",
                "--vehicle",
                "tractor5",
                "--sensor",
                "L1:body=tractor,behind=axle1,distance=-0.29,forward=y",
                "--speed",
                "2.0",
            ),
            *("--hump", "half_sine,length=0.5,height=0.03", "--out", "out/run.yaml"),
        ),
    ),
}


def mutate(random: Random, case: Case) -> Case:
    """Return a case with one more mutation."""
    kind = random.random()
    if case.format == "export":
        return special_file(random, case) if kind < 0.02 else mutate_export(random, case)
    if case.format == "table" and kind < 0.85:
        return mutate_table(random, case)
    if kind < 0.03:
        return special_file(random, case)
    if kind < 0.09:
        bulk = {"vehicle": bulk_vehicle, "run": bulk_run, "table": bulk_run}.get(case.format, bulk_entries)
        return bulk(random, case)
    return random.choice(TEXT_MUTATIONS)(random, case) if kind < 0.4 else mutate_tree(random, case)


def make_case(seed: int, number: int, compiling: float = 0.0) -> Case:
    """Return case `number` of a seed; formats take turns.

    Parameters
    ----------
    seed, number
        Any integers.
    compiling
        Share of the cases that go through a command that compiles a kernel: seconds each.
    """
    format = FORMATS[number % len(FORMATS)]
    random = generator(seed, format, number)
    if format == "options":
        return hostile_options(random, compiling)
    case = random.choice(healthy()[format])
    for _ in range(random.choice((1, 1, 1, 2, 2, 3))):
        case = mutate(random, case)
    share = random.random()
    chosen = COMPILING.get(format, ()) if share < compiling else COMMANDS.get(format, ()) if share < compiling + 0.15 else ()
    if chosen:
        command = random.choice(chosen)
        case = replace(case, command=tuple(case.main if word == "MAIN" else word for word in command))
    return case
