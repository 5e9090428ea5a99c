# %% [markdown]
# # A law and an effect of your own
#
# vehgen brings a [library of force laws](../force-laws.md) and one of [effects](../effects.md) that a diagnosis can
# name. Neither has to suffice: a law is an expression of travel `d` and rate `v` in a vehicle file, an effect an entry
# of a YAML file. Neither is a program: what is no expression is refused.

# %%
# The files of the examples, copied into a folder of their own: what is written here stays there.
import atexit
import os
import shutil
import tempfile
from pathlib import Path

examples = Path(globals().get("__file__", "notebook")).resolve().parent.parent / "examples"
if (examples / "my_truck.yaml").is_file():  # else they are expected in the current folder
    own = tempfile.mkdtemp()
    atexit.register(shutil.rmtree, own, ignore_errors=True)
    shutil.copytree(examples, own, dirs_exist_ok=True)
    os.chdir(own)

# %%
# %matplotlib inline
import matplotlib.pyplot as plt
import numpy as np
import pandas as pd

import vehgen

# %% [markdown]
# ## The law
#
# A damper whose force grows with the cube of its rate, in the front suspension of a sedan.

# %%
Path("cubic_damper.yaml").write_text("""
extends: sedan2
axles:
  front:
    suspension:
      laws:
        - law: {force: c3*v^3, parameters: {c3: 3 kN s^3/m^3}}
""")
sedan = vehgen.load_vehicle("cubic_damper.yaml")
print(sedan.axles["front"].suspension.laws[0]["law"]["force"])

# %% [markdown]
# It is compiled into the same kernel as everything else. A hump, crossed without and with it:

# %%
RUN = """
vehicle: {vehicle}
speed: {speed} m/s
duration: 5 s
sample: 10 ms
road: [{{hump: {{shape: half_sine, length: 0.5 m, height: {height} m, at: 4 m}}}}]
sensors:
  F: {{body: body, behind: front, channels: {{acceleration: F_az, pitch_rate: F_q}}}}
  R: {{body: body, behind: rear, channels: {{acceleration: R_az, pitch_rate: R_q}}}}
"""
CROSSINGS = {"low": (2, 0.03), "high": (2, 0.08), "fast": (4, 0.08)}
figure, axes = plt.subplots(figsize=(7, 3))
for vehicle in ("sedan2", "cubic_damper.yaml"):
    Path("crossing.yaml").write_text(RUN.format(vehicle=vehicle, speed=4, height=0.08))
    response = vehgen.simulate("crossing.yaml")
    axes.plot(response.time, response.channel("F_az")[0], label=vehicle, linewidth=1)
axes.set(xlabel="time [s]", ylabel="front acceleration [m/s^2]", xlim=(0.8, 3))
axes.legend()
figure.tight_layout()

# %% [markdown]
# ## Recordings of it
#
# Synthetic ones, with noise: from now on nobody knows of the law.

# %%
rng = np.random.default_rng(3)
runs = []
for name, (speed, height) in CROSSINGS.items():
    Path("crossing.yaml").write_text(RUN.format(vehicle="cubic_damper.yaml", speed=speed, height=height))
    response = vehgen.simulate("crossing.yaml")
    names = [channel.name for channel in response.channels]
    noise = [0.01 if channel.endswith("az") else 0.001 for channel in names]
    recorded = response.values[0] + noise * rng.standard_normal(response.values[0].shape)
    pd.DataFrame(recorded, columns=names, index=pd.Index(response.time, name="t")).to_csv(f"{name}.csv")
    Path(f"{name}.yaml").write_text(
        RUN.format(vehicle="sedan2", speed=speed, height=height) + f"recording: {name}.csv\nacquisition: none\n"
    )
    runs.append(f"{name}.yaml")

# %% [markdown]
# ## The effect
#
# What could be missing, with the range to search: multiples of a size of the place, here its damping over the square of
# a usual rate.

# %%
Path("my_effects.yaml").write_text("""
effects:
  cubic_damper:
    title: Damper that grows with the cube of its rate
    meaning: a damper whose valves choke as it moves faster
    attaches: suspension
    force: c3*v^3
    parameters:
      c3: {unit: N s^3/m^3, low: 0.001, high: 100, starts: [0.1, 1], times: c/(0.5 m/s)^2, meaning: cubic damping}
""")
mine = vehgen.effects("my_effects.yaml")["cubic_damper"]
print(mine.name, "-", mine.meaning)

# %% [markdown]
# ## Found?
#
# It competes with friction, stops and the library's own dampers.

# %%
rivals = ["dry_friction", "bump_stop", "quadratic_damping", "cubic_stiffness", "asymmetric_damping"]
diagnosis = vehgen.diagnose("sedan2", runs, effects=["cubic_damper", *rivals], library="my_effects.yaml")
print(diagnosis.verdict.verdict, "-", diagnosis.verdict.reason)

# %%
diagnosis

# %% [markdown]
# The recordings were made with 3000 N s^3/m^3 in the front suspension. An entry point lets a package bring effects of
# its own; the [page on effects](../effects.md#your-own-effect) has the three kinds.
