"""Write effects.md from the library of effects, with a picture of each: a hump run without and with it.

Run it after changing the library: `python docs/generate/effects_page.py`. A test fails while the page and the library differ.
"""

from __future__ import annotations

import tempfile
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

from vehgen.effects import EFFECTS, Effect
from vehgen.measure import record_psd
from vehgen.measure.curves import ChannelCurves
from vehgen.report.drawing.canvas import INK
from vehgen.report.plots.comparison import MEASURED, PSD_DECADES, QUANTITY_UNITS, SIMULATED, busy
from vehgen.simulate import SimulatorPool

HERE = Path(__file__).parents[1]
PAGE = HERE / "effects.md"
IMAGES = HERE / "images" / "effects"
RUN = """vehicle: tractor5.yaml
speed: 2.5 m/s
duration: 9 s
road: [{hump: {shape: half_sine, length: 0.5 m, height: 0.05 m, at: 2 m}}]
sensors:
  L1: {body: tractor, behind: axle1, distance: -0.29 m, channels: {acceleration: L1_az, pitch_rate: L1_q}}
  L2: {body: semitrailer, behind: fifth_wheel, distance: 9.115 m, channels: {acceleration: L2_az, pitch_rate: L2_q}}
recording: nothing.csv
"""
OWN = """\
## Your own effect

One entry of a YAML file, given to `effects` and `diagnose` with `--library my_effects.yaml` (repeatable):

```yaml
effects:
  soft_damper:
    title: Damper with a soft centre
    meaning: a damper whose valves close as it moves faster
    signature: damping that grows with the hump's height and the speed
    attaches: suspension                # suspension, tyre or hinge
    force: c3*v^3 + k3*d^3              # of travel d, rate v and its parameters; compression is positive
    parameters:
      c3: {unit: N s^3/m^3, low: 0.01, high: 100, starts: [0.3, 3], times: c/(0.1 m/s)^2, meaning: cubic damping}
      k3: {unit: N/m^3, low: 1e4, high: 1e9, starts: [1e7], meaning: cubic stiffness}
  symmetric_stop:
    title: Stops of equal clearance
    meaning: bump and rebound stops that are met after the same travel
    attaches: suspension
    law: {bump_stop: {k: 2 * k, clearance: gap, rebound: gap}}
    parameters:
      k: {unit: N/m, low: 0.25, high: 15, starts: [3], times: k, meaning: half the stiffness of the stops}
      gap: {unit: mm, low: 1, high: 60, starts: [8, 15, 25], meaning: clearance}
  stiff_carcass:
    title: Hardening tyres
    meaning: tyres that grow stiffer as they are pressed
    attaches: tyre
    global: true                        # of all tyres as well as of each
    force: k3*d^3
    parameters:
      k3: {unit: N/m^3, low: 0.1, high: 100, starts: [1, 10], times: kt/(20 mm)^2, meaning: cubic stiffness}
  late_phone:
    title: Phone with a late clock
    meaning: a phone that stamps its samples late
    adjusts: delay                      # speed, footprint, gain, delay, tilt or position
    parameters:
      late: {unit: ms, low: -200, high: 200, starts: [-20, 20], meaning: late against the first sensor}
  cooling_fan:
    title: Cooling fan
    meaning: a fan that is out of balance
    line: {low: 8 Hz, high: 30 Hz}      # in between, the strongest lines are tried
```

An entry is one of three kinds:

- **of the vehicle**: `force`, an expression as of [your own law](force-laws.md#your-own-law), or `law`, one of the
  [force laws](force-laws.md) with each of its parameters a number with its unit or an expression of the effect's. `attaches` says where.
- **of runs or sensors**: `adjusts` names one quantity, its one parameter is that quantity's number. `speed` (true speed over that of the
  run file) and `footprint` (contact length of the tyres) are of all runs, `gain` (reading over truth) of a channel, `delay` (how late),
  `tilt` (nose-down angle) and `position` (how far ahead of where the run file says) of a sensor.
- **a line of the spectrum**: `line` gives the frequencies between which it lies. Frequency and drift are searched; the force at a body,
  its amplitude and phase, is solved for in every run. It has no parameters of its own.

`low`, `high` and `starts` count in `unit`, or with `times` as multiples of a size of the place: an expression of its static `load`, its
suspension's `k` and `c`, its tyre's `kt`, its body's `mass`, `inertia` and `length`, and a typical `travel` (of groups: means).
Runs and sensors have no sizes. `signature`, `source` and `global` may be left out. `global: true` says that no single place explains the
effect: it is tried wherever a force at one place does not suffice. Units are checked when the file is read.
`vehgen schema --effects` prints the JSON Schema.

What needs more (a new body, say) is an object in any installed package that names it under the entry point group `vehgen.effects`:

```python
from vehgen.effects import EffectParameter, VehicleEffect
from vehgen.effects.places import hinges

HINGE_DAMPING = VehicleEffect(
    name="hinge_damping",
    title="Hinge damping",
    equation="M = c*(pitch rate of the second body - pitch rate of the first)",
    meaning="a damper between the two bodies",
    attaches="hinge",
    places=hinges,
    parameters=(EffectParameter("c", "N m s", "damping against pitch", low=0.001, high=1.0, starts=(0.02,), scale=lambda site: site.load),),
    edit=lambda site, symbols: {"hinges": {site.place: {"c": symbols["c"]}}},
)
```

```toml
[project.entry-points."vehgen.effects"]
hinge_damping = "my_package:HINGE_DAMPING"
```

`edit` returns what a vehicle file that extends the base would say; the symbols, and what the vehicle says at the place, are expressions
that take part in arithmetic: `{"c": site.spring.c + 2*symbols["c"]}`. A `RunEffect` names an `adjustment`, a class of
[vehgen.fit.adjustments](../src/vehgen/fit/adjustments.py) or one of your own; a `LineEffect` says between which frequencies lines are
`looked_for`; what is none of these is a class of your own with the methods of [`Effect`](../src/vehgen/effects/base.py). Each may set
`is_global`, and name in `special_case` the effect that it is at some value of its parameters: where both do as well, that one is named."""
SHOWN_HZ = (0.5, 25.0)
SHOWN = {"hinge_friction": "L2_q", "hinge_stiffness": "L2_q"} | dict.fromkeys(
    ("walking_beam", "cargo_module", "frame_bending", "sensor_delay"), "L2_az"
)
"""The channel that shows an effect best; L1_az otherwise."""
FREED = {"k": "the stiffness", "c": "the damping", "kt": "the tyre's stiffness"}
"""What an effect frees, in words."""
PLACES = {"walking_beam": "axle4+axle5", "cargo_module": "semitrailer", "frame_bending": "semitrailer", "sensor_delay": "L2"}

SHAKEN = {"engine_harmonic": ((17.8, 0.01), (0,)), "wheel_runout": ((0.5,), (0, 2, 4))}
"""What shakes the vehicle all the time: at these numbers, with these parts."""
UNDRAWN = ("added_stiffness",)
"""Effects that have no place on tractor5."""


def page() -> str:
    """Return the page's text."""
    lines = [
        "# Effects",
        "",
        "Made by `python docs/generate/effects_page.py` from the library.",
        "",
        "What `vehgen diagnose` can name. Ranges are what it searches: in the parameter's unit, or as multiples of a size",
        "of the place: its static load, stiffness or damping, or a typical travel (a tenth of what the static load compresses the spring",
        "by, between 2 and 20 mm; half the stroke on a rig). Every picture shows tractor5 over a hump of 50 mm at 2.5 m/s, without the",
        "effect (grey) and with it (blue), at the strength at which a search begins. What lives at a suspension is also looked for in",
        "all suspensions alike (`all suspensions`), and in those of a body's axles behind the first (`axle4 and axle5`).",
        "",
        *OWN.splitlines(),
        "",
    ]
    for effect in EFFECTS.values():
        lines += [f"## {effect.name}", "", f"**{effect.title}**: {effect.meaning}.", "", f"    {effect.equation}", ""]
        lines += [f"Lives at: {effect.attaches}. Looks like: {effect.signature}.", ""]
        if effect.parameters:
            lines += ["| parameter | unit | searched | meaning |", "|---|---|---|---|"]
            lines += [f"| `{item.name}` | {item.unit} | {item.searched} | {item.meaning} |" for item in effect.parameters]
            lines.append("")
        if effect.frees:
            lines += [f"Its fits search {' and '.join(map(FREED.get, effect.frees))} there within the file's whole range.", ""]
        if effect.name not in UNDRAWN:
            lines += [f"![{effect.title}, before and after](images/effects/{effect.name}.svg)", ""]
        lines += [f"Source: {effect.source}.", ""]
    return "\n".join(lines)


def draw() -> None:
    """Draw every effect."""
    from vehgen.diagnose.fits.candidate import build_problem, list_candidates
    from vehgen.effects import EffectLocator
    from vehgen.fit.adjustments import RunState
    from vehgen.fit.misfit import Misfit
    from vehgen.fit.noise import EVEN, Noise
    from vehgen.fit.problem import make_problem
    from vehgen.fit.shaking import Shaking
    from vehgen.fit.trial import load_trials
    from vehgen.report import save_figure

    IMAGES.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "run.yaml").write_text(RUN, encoding="utf-8")
        t = np.arange(901) * 0.01
        noise = np.random.default_rng(0).standard_normal((901, 4))
        np.savetxt(folder / "nothing.csv", np.column_stack([t, noise]), delimiter=",", header="t,L1_az,L1_q,L2_az,L2_q", comments="")
        problem = make_problem(load_trials([folder / "run.yaml"]))
    trial = problem.trials[0]
    surveyor = EffectLocator(trial.run.vehicle, dict(trial.values))
    base = problem.respond(problem.space.start[None], trial)[0][0]
    for effect in EFFECTS.values():
        candidates = list_candidates(trial.run.vehicle, problem.trials, [effect])
        if not candidates:
            continue
        wanted = PLACES.get(effect.name)
        candidate = next((item for item in candidates if item.place == wanted), candidates[0])
        posed = build_problem(candidate, problem, surveyor, SimulatorPool())
        combination = effect.starts(candidate.place, surveyor)[-1]
        values = posed.space.start.copy()
        if candidate.parameters:
            values[problem.space.size :] = combination[: len(candidate.parameters)]
        noises = {trial.name: Noise(EVEN, np.ones(4))}
        misfit = Misfit(posed, noises, values, shared=candidate.shared)
        shaking = candidate.shared[0] if candidate.shared else None
        if isinstance(shaking, Shaking):
            numbers, shown = SHAKEN[effect.name]
            size = effect.solved_parameters[0].first(surveyor.site(candidate.place))[0]
            columns = shaking.columns(trial, np.array(numbers), trial.values, RunState(trial.scenario))
            changed = base + size * columns[list(shown)].sum(axis=0)
        else:
            numbers = np.array(combination[: len(candidate.shared)]) if candidate.shared else np.zeros(0)
            changed = misfit.respond(0, values[None], numbers, np.zeros(len(misfit.errors[0].items)))[0]
        save_figure(_figure(effect, trial.recording.time, base, changed, list(trial.channels)), IMAGES / f"{effect.name}.svg")


def _figure(effect: Effect, t: np.ndarray, base: np.ndarray, changed: np.ndarray, channels: list[str]) -> Figure:
    """Plot one channel's history beside its PSD, without and with an effect."""
    channel = SHOWN.get(effect.name, "L1_az")
    i = channels.index(channel)
    quantity = "acceleration" if channel.endswith("az") else "pitch_rate"
    history = ChannelCurves("", channel, quantity, t, base[:, i], changed[:, i])
    frequency, before = record_psd(base[:, i], 0.01)
    density = ChannelCurves("", channel, quantity, frequency, before, record_psd(changed[:, i], 0.01)[1])
    figure = Figure(figsize=(9.0, 2.3), layout="constrained")
    left, right = figure.subplots(1, 2)
    unit = QUANTITY_UNITS.get(history.quantity, "")
    left.plot(history.x, history.measured, color=MEASURED, lw=2.0, label="without")
    left.plot(history.x, history.simulated, color=SIMULATED, lw=0.9, label="with")
    left.set_xlim(*busy([history]))
    left.set_xlabel("time [s]", color=INK)
    left.set_ylabel(f"{history.channel} [{unit}]", color=INK, parse_math=False)
    inside = (density.x >= SHOWN_HZ[0]) & (density.x <= SHOWN_HZ[1])
    right.semilogy(density.x[inside], density.measured[inside], color=MEASURED, lw=2.0)
    right.semilogy(density.x[inside], density.simulated[inside], color=SIMULATED, lw=0.9)
    top = max(density.measured[inside].max(), density.simulated[inside].max())
    right.set_ylim(top * 10.0**-PSD_DECADES, 3 * top)
    right.set_xlabel("frequency [Hz]", color=INK)
    right.set_ylabel(f"PSD [({unit})²/Hz]", color=INK)
    for axes in (left, right):
        axes.grid(color="#e3e7ea", lw=0.6)
        axes.spines[["top", "right"]].set_visible(False)
    figure.legend(loc="outside upper right", ncols=2, frameon=False, fontsize=9)
    return figure


if __name__ == "__main__":
    draw()
    PAGE.write_text(page(), encoding="utf-8")
