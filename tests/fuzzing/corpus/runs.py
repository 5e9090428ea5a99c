"""Run files: names of columns that would be code, sizes that cost minutes or gigabytes, files that are none."""

from __future__ import annotations

from tests.fuzzing.corpus.entry import Nasty, marked
from tests.fuzzing.corpus.vehicles import HOSTILE, quoted

HEAD = "vehicle: my_truck.yaml\n"
HUMP = "  - hump: {shape: half_sine, length: 0.5 m, height: 3 cm, at: 2 m}\n"
SENSORS = "sensors:\n  S: {body: body, channels: {acceleration: az}}\n"
RUN = f"{HEAD}speed: 2 m/s\nduration: 4 s\nroad:\n{HUMP}{SENSORS}"
SIMULATE = ("simulate", "run.yaml", "--out", "out/response.csv")


def channel(i: int, text: str) -> list[Nasty]:
    """Return runs whose channel, sensor or output is a hostile text; the heading of a column may be any text of one line."""
    name = quoted(text)
    return [
        marked("run", f"channel {i}", RUN.replace(": az", f": {name}"), refused=False),
        marked("run", f"column {i}", RUN.replace("az", f"{{column: {name}}}"), refused=False),
        marked("run", f"sensor {i}", RUN.replace("  S:", f"  §{name}:")),
        marked("run", f"output {i}", f"{RUN}outputs:\n  §{name}: {{axle: front, quantity: tyre_force}}\n"),
        marked("run", f"force {i}", f"{RUN}forces:\n  §{name}: {{body: body, harmonic: {{amplitude: 1 N, frequency: 1 Hz}}}}\n"),
    ]


def hump(name: str, text: str) -> Nasty:
    """Return a run over another hump."""
    return marked("run", name, RUN.replace("length: 0.5 m, height: 3 cm, at: 2 m", text))


def path(place: str, text: str) -> list[Nasty]:
    """Return runs in which a path stands for something that is no regular file; `text` holds PATH."""
    paths = ("/dev/zero", "/dev/stdin", "/proc/self/mem", "/", "pipe", "absent", "x" * 5000, "y/" * 3000, '"a\\0b"')
    return [marked("run", f"{place} {name[:20]}", text.replace("PATH", name)) for name in paths]


EXPLOIT = r"""vehicle: quarter_car
speed: 2 m/s
duration: 1 s
sensors:
  A: {body: body, channels: {acceleration: §"pwn\"\"\"\nopen('PWNED','w').write('x')\n\"\"\""}}
"""

RUNS: tuple[Nasty, ...] = (
    marked("run", "a file written from a name", EXPLOIT),
    marked("run", "a file written from a name, simulated", EXPLOIT, command=SIMULATE),
    *(nasty for i, text in enumerate(HOSTILE) for nasty in channel(i, text)[: 5 if i < 3 else 1]),
    marked("run", "two channels called t", RUN.replace("az}", "§t}")),
    marked("run", "two channels of one name", RUN.replace("{acceleration: az}", "{acceleration: az, pitch_rate: §az}")),
    hump("hump 1e6 m long", "length: §1e6 m, height: 3 cm, at: 2 m"),
    marked("run", "hump 100 m long", RUN.replace("length: 0.5 m", "length: 100 m"), refused=False),
    hump("hump of no length", "length: §0 m, height: 3 cm, at: 2 m"),
    hump("hump 1e-300 m long", "length: §1e-300 m, height: 3 cm, at: 2 m"),
    hump("hump at 1e12 m", "length: 0.5 m, height: 3 cm, at: §1e12 m"),
    hump("hump 1e9 m high", "length: 0.5 m, height: §1e9 m, at: 2 m"),
    marked("run", "1000 humps", RUN.replace(HUMP, "".join(HUMP.replace("at: 2", f"at: {i}") for i in range(1000))), refused=False),
    marked("run", "rectangle of a wrong radius", RUN.replace("half_sine, length", "rectangle, radius: 9 m, length")),
    *(
        marked("run", f"speed {speed}", RUN.replace("2 m/s", f"§{speed}").replace("duration: 4 s\n", ""))
        for speed in ("1e-6 m/s", "1e6 m/s", "-2 m/s", "0 m/s", ".nan", "1e300 km/h")
    ),
    *(
        marked(
            "run", f"ISO 8608 at {speed} m/s", f"{HEAD}speed: §{speed} m/s\nduration: 1000 s\nroad:\n  - iso8608: {{class: B, seed: 1}}\n"
        )
        for speed in ("1e6", "1e3")
    ),
    *(
        marked("run", f"seed {seed}", f"{HEAD}speed: 9 m/s\nduration: 1 s\nroad:\n  - iso8608: {{class: B, seed: §{seed}}}\n")
        for seed in ("-1", "1e300", "x")
    ),
    *(
        marked("run", f"{name}, as large as it may be", f"vehicle: quarter_car\n{text}", refused=False)
        for name, text in (
            ("numbers", "speed: 8 m/s\nduration: 2480 s\nroad:\n  - iso8608: {class: B}\n"),
            ("footprint", "speed: 8 m/s\nduration: 870 s\nfootprint: 0.2 m\nroad:\n  - iso8608: {class: B}\n"),
            ("random road", "speed: 50 m/s\nduration: 990 s\nroad:\n  - iso8608: {class: B}\n"),
            ("many humps", f"speed: 8 m/s\nduration: 240 s\nroad:\n{''.join(HUMP.replace('at: 2', f'at: {i}') for i in range(200))}"),
        )
    ),
    marked("run", "footprint 1e9 m", f"footprint: §1e9 m\n{RUN}"),
    marked("run", "duration 1e-9 s", RUN.replace("duration: 4 s", "duration: §1e-9 s")),
    marked("run", "duration 1e9 s", RUN.replace("duration: 4 s", "duration: §1e9 s")),
    marked("run", "sample 1e9 s", f"sample: §1e9 s\n{RUN}"),
    marked("run", "step 1e-12 s", f"step: §1e-12 s\n{RUN}"),
    marked("run", "step of no length", f"step: §0 s\n{RUN}"),
    marked("run", "force at 1e300 Hz", f"{RUN}forces:\n  f: {{body: body, harmonic: {{amplitude: 1 N, frequency: §1e300 Hz}}}}\n"),
    marked("run", "units of nonsense", RUN.replace("2 m/s", "§2 furlong/fortnight")),
    *path("vehicle", f"vehicle: §PATH\n{RUN.partition(chr(10))[2]}"),
    *path("speed", RUN.replace("2 m/s", "{file: §PATH, time: t, speed: v}")),
    *path("profile", RUN.replace(HUMP, "  - profile: {file: §PATH, distance: s, height: h}\n")),
    *path("points", RUN.replace(HUMP, "  - hump: {shape: points, file: §PATH, distance: s, height_column: h, at: 2 m}\n")),
    *path("force", f"{RUN}forces:\n  f: {{body: body, file: §PATH, time: t, force: F}}\n"),
)
