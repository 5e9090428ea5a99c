"""Write force-laws.md from the library of laws: `python docs/generate/force_laws_page.py`."""

from __future__ import annotations

from pathlib import Path

from vehgen.mechanics.laws import LAWS

PAGE = Path(__file__).parents[1] / "force-laws.md"
HEAD = """\
# Force laws

Made by `python docs/generate/force_laws_page.py` from the library.

A suspension, tyre, link or hinge may carry any number of laws in parallel with its k and c:

```yaml
axles:
  axle1:
    body: tractor
    x: b1
    mass: m1
    suspension: {k: k1, c: c1, laws: [{dry_friction: {force: 3 kN}}, {bump_stop: {k: 2 MN/m, clearance: 60 mm}}]}
    tyre: {k: kt1, laws: [{tyre_liftoff: {}}]}
```

Travel d and rate v are positive in compression and count from static equilibrium. On a hinge they are the relative pitch and its
rate, and forces are moments.
A parameter of a law may be an expression of the vehicle's parameters, so that calibration can search it;
its strength at zero gives the linear vehicle.

## Where travel counts from

A bump stop, a cubic, quadratic or progressive spring and an own law may say `from: unloaded`: d then counts from the position in which the
spring carries nothing, as a maker's drawing has it, instead of from static equilibrium (`from: static`, the default).

```yaml
suspension: {k: k1, c: c1, laws: [{bump_stop: {k: 2 MN/m, clearance: 90 mm, from: unloaded}}]}
```

Such laws share in carrying the weight. Before a run their equilibrium K q + J^T f(J q) = W is solved for every individual; the kernel then
applies f(d_static + d) - f(d_static), static loads follow the same solution, and a tyre leaves the road at the load that the laws leave
it. An individual without a stable equilibrium fails with that reason. Modes and matrices stay those of the linear k and c.

## Many candidates in one kernel

`vehgen.mechanics.superset.add_laws` adds any number of laws at once, each switched off by its strength, so that hundreds of variants are
individuals of one population and share one compiled kernel:

```python
from vehgen import Place, PointOutput, Simulator, load_vehicle
from vehgen.mechanics.superset import add_laws

vehicle = load_vehicle("tractor5.yaml")
outputs = [PointOutput("cab", Place("over axle 1", "tractor"), "acceleration")]
superset = add_laws(vehicle, [("axle1", "suspension", "dry_friction"), ("axle1", "tyre", "tyre_liftoff")])
simulator = Simulator(superset.vehicle, outputs)
population = simulator.parameters([{superset.strength(candidate): 2e3} for candidate in superset.names])
```

`superset.names[candidate]` names the law's other parameters in the vehicle. [performance.md](performance.md) says when it pays.

## Your own law

It is an expression of d, v and its parameters:

```yaml
suspension: {k: k1, c: c1, laws: [{law: {force: k3*d**3, parameters: {k3: 5e7 N/m^3}}}]}
```

`sqrt`, `abs`, `sign`, `min` and `max` may be used. Its units are checked like any other. A force that jumps, or is
infinitely steep, where d or v passes 0 is refused: dry friction is the law `dry_friction`.
"""


def page() -> str:
    """Return the page's text."""
    lines = [HEAD]
    for law in LAWS.values():
        lines += [f"## {law.name}", "", f"**{law.title}.** {law.meaning[0].upper()}{law.meaning[1:]}.", "", f"    {law.equation}", ""]
        lines += ["| parameter | unit on a spring | usual range, SI | meaning |", "|---|---|---|---|"]
        for item in law.parameters:
            optional = "" if item.default is None else f" (default {item.default:g})"
            unit = str(item.dimension("link")).replace("no unit", "–")
            lines.append(f"| `{item.name}`{optional} | {unit} | {item.low:g} to {item.high:g} | {item.meaning} |")
        neutral = f"Adds nothing at `{law.strength}` = {law.neutral:g}."
        lines += ["", f"{neutral} On: {', '.join(law.attaches_to)}. Source: {law.source}.", ""]
    return "\n".join(lines).rstrip() + "\n"


if __name__ == "__main__":
    PAGE.write_text(page(), encoding="utf-8")
