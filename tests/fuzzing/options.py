"""Hostile options: healthy command lines of every command but `import`, of which some words are exchanged, added, repeated or dropped.

The commands are called from the folder that holds their files and may hold their results, and may do nothing outside it.
"""

from __future__ import annotations

import os
from functools import cache
from random import Random

from tests.fuzzing.cases import Case
from tests.fuzzing.healthy import EFFECTS, healthy, read, table
from tests.fuzzing.hostile import MARK, NUMBERS, PATHS, SIZES, TEXTS

CAR = b"extends: quarter_car\nsets: {stiff: {kS: 2 MN/m}}\n"
RUN = b"""\
vehicle: car.yaml
speed: 2 m/s
duration: 4 s
road:
  - hump: {shape: half_sine, length: 0.5 m, height: 0.03 m, at: 1 m}
sensors:
  A: {body: body, channels: {acceleration: A_az}}
"""
QUICK = (
    "modes car.yaml --set stiff",
    "static car.yaml --set stiff --json",
    "report result.json --out out",
    "laden tractor5 pallets.yaml --set DHCM-1-2 --out laden.yaml",
    "module frame.yaml --mass total --out cargo.yaml --plot picture.svg",
    "effects --library effects.yaml",
    "transmissibility phone.csv --columns time=t,acceleration=az,pitch_rate=q --vehicle car.yaml --set stiff --sensor S:body=body"
    " --reference S --speed 5 --bands 4,15 --segment 0.6 --forward y --out rough",
    "models --json",
    "new semitrailer --out begun.yaml",
    "completion bash",
    "schema --run",
    "response car.yaml --set stiff --speed 5 --road B --at S:body=body,behind=axle1,distance=0.1 --out roads",
    "export car.yaml --to json --set stiff --run run.yaml --step 0.001 --out car.json",
)
COMPILING = (
    "build car.yaml --set stiff --no-plots --out built",
    "simulate run.yaml --out response.csv",
    "assess run.yaml --weighting Wb --slope 3 --from 1 --out assessed",
    "assess measured.yaml --recorded --out assessed",
    "validate car.yaml measured.yaml --bands 2,5,8 --astm II --out validated",
    "calibrate car.yaml measured.yaml --method joint --sensors A --freeze kS --search ga --size 4 --generations 1 --seed 1 --starts 1"
    " --no-polish --band 0.5,30 --height-error 0.02 --speed-error 0.01 --combination kS/mG --bootstrap 0 --facts facts.yaml"
    " --out calibrated",
    "sensors car.yaml run.yaml --count 1 --parameters kS,cS",
    "sensitivity car.yaml run.yaml --parameters kS --out sensitive",
    "bench --individuals 0 --seconds 0.05",
)
REFUSED = "diagnose car.yaml run.yaml --effects dry_friction --library effects.yaml --everywhere --out diagnosed"
"""A diagnosis of a run without recording: a whole one takes minutes and processes of its own."""
FLAGS = frozenset(
    {"--json", "--plot", "--force", "--recorded", "--run", "--everywhere", "--no-plots", "--no-polish", "--resume", "--convergence"}
)
WRITTEN = frozenset({"--out", "--plot"})


@cache
def files() -> dict[str, bytes]:
    """Return the files that the commands read, in the folder `out`."""
    found = {
        "car.yaml": CAR,
        "run.yaml": RUN,
        "measured.yaml": RUN + b"recording: recording.csv\n",
        "recording.csv": table("t,A_az", 401, 0.01, 1),
        "phone.csv": table("t,az,q", 401, 0.01, 2),
        "pallets.yaml": read("docs/examples/cargo/pallets.yaml"),
        "frame.yaml": healthy()["frame"][0].files["frame.yaml"],
        "effects.yaml": EFFECTS.encode(),
        "facts.yaml": b"parameters: {mG: {value: 1 t, uncertainty: 10 kg}}\n",
        "result.json": b"{}\n",
    }
    return {f"out/{name}": data for name, data in found.items()}


def stays_inside(text: str) -> bool:
    """Whether a name, taken as one of a result, lies in the folder that the command is called from."""
    path = os.path.normpath(text)
    return not os.path.isabs(path) and path.partition(os.sep)[0] != os.pardir


def hostile_word(random: Random, option: str = "") -> str:
    """Return what may stand in place of a word; as the name of a result one that a command may write, or must refuse."""
    kinds = (TEXTS, tuple(map(str, NUMBERS[:-4])), SIZES, (*PATHS, *(name.removeprefix("out/") for name in files())))
    words = random.choice(kinds[:1] + kinds[3:] if option in WRITTEN else kinds)
    word = random.choice(words)
    if option not in WRITTEN and random.random() < 0.2:
        word = random.choice((f"{word},{word}", f",{word},", f"{word}=1", f"1,{word}"))
    return word if option not in WRITTEN or stays_inside(word) else f"./--{MARK}"


def pairs_of(words: list[str]) -> list[tuple[str, ...]]:
    """Return a command's words with every option beside its value."""
    found: list[tuple[str, ...]] = []
    for word in words:
        if found and len(found[-1]) == 1 and found[-1][0].startswith("--") and not is_flag(found[-1][0], word):
            found[-1] = (*found[-1], word)
        else:
            found.append((word,))
    return found


def is_flag(option: str, word: str) -> bool:
    """Whether an option stands alone before a word."""
    return word.startswith("--") or (option in FLAGS and option != "--plot")


def mutate(random: Random, items: list[tuple[str, ...]]) -> list[tuple[str, ...]]:
    """Change one argument of a command."""
    i = random.randrange(len(items))
    item = items[i]
    option = item[0] if item[0].startswith("--") else ""
    kind = random.choice((*("value",) * 8, "add", "repeat", "drop", "name"))
    if kind == "value" and len(item) == 2:
        word = hostile_word(random, option)
        items[i] = (f"{option}={word}",) if random.random() < 0.6 else (option, word)
    elif kind == "value" and not option:
        items[i] = (hostile_word(random),)
    elif kind == "repeat":
        items[i:i] = [item] * random.choice((1, 1, 300))
    elif kind == "drop" and option != "--out":
        del items[i]
    elif kind == "name" and option:
        items[i] = (random.choice((option[:-1], option.upper(), option + "s", option.replace("--", "-", 1))), *item[1:])
    else:
        word = hostile_word(random)
        stray = random.choice((word, "--", "-", "@run.yaml", "--json", f"--{MARK}", f"--set={word}", "--version"))
        items.insert(random.choice((0, len(items))), (stray,))
    return items


def hostile_options(random: Random, compiling: float) -> Case:
    """Return a case of the format `options`.

    Parameters
    ----------
    random
        Its random numbers.
    compiling
        Share of the cases that may compile kernels; the other calls of such commands name a run or a vehicle that is absent.
    """
    line = random.choice((*QUICK, *COMPILING, REFUSED))
    if line in COMPILING and random.random() >= compiling:
        line = line.replace("run.yaml" if "run.yaml" in line else "car.yaml", "absent.yaml").replace("bench", "bench --jsn")
    name, *words = line.split()
    items = pairs_of(words)
    for _ in range(random.choice((1, 1, 1, 2, 3))):
        items = mutate(random, items) if items else [(hostile_word(random),)]
    command = (name, *(word for item in items for word in item))
    return Case("options", files(), "out/run.yaml", command, mutations=("options",))
