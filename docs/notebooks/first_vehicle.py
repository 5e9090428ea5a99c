# %% [markdown]
# # Your first vehicle
#
# A quarter of a truck, then the whole truck: declared, checked, looked at, driven over a hump. Everything here is a few
# lines of Python; [the tutorial](../tutorial.md) does the same from the command line.

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
import numpy as np

import vehgen

# %% [markdown]
# ## Declare it
#
# A vehicle is a text: bodies, axles, and what joins them. Numbers carry their units, expressions may use parameters.

# %%
quarter = vehgen.parse_vehicle("""
name: quarter
title: A quarter of a truck
parameters:
  k: {value: 300 kN/m, meaning: air spring}
  c: {value: 12 kN s/m, meaning: damper}
bodies:
  body: {mass: 4 t, motions: [heave]}
axles:
  axle: {body: body, mass: 500 kg, suspension: {k: k, c: c}, tyre: {k: 1.6 MN/m}}
""")
vehgen.natural_modes(quarter)

# %% [markdown]
# Two motions, so two modes. The textbook's estimates, a body on both springs in series and an axle between them, are
# close:

# %%
series = 1 / (1 / 300e3 + 1 / 1.6e6)
print(f"body {np.sqrt(series / 4000) / 2 / np.pi:.2f} Hz, axle {np.sqrt(1.9e6 / 500) / 2 / np.pi:.2f} Hz")

# %% [markdown]
# What does not fit is refused with its place and what would be right:

# %%
try:
    vehgen.parse_vehicle("extends: tractor5\nparameters: {k1: {value: 800 kg}}")
except vehgen.InputError as error:
    print(error)

# %% [markdown]
# ## The whole truck
#
# `my_truck.yaml` is a two-axle truck. Its equations are derived in symbols, by Lagrange's method; `M`, `C`, `K` and `P`
# are matrices of sympy.

# %%
truck = vehgen.load_vehicle("my_truck.yaml")
model = vehgen.derive(truck)
model.K

# %%
vehgen.draw_vehicle(model)

# %%
vehgen.static_loads(truck)

# %% [markdown]
# ## Drive it
#
# A run file says how fast, over which road, and what is wanted. This one drives a road train over two humps.

# %%
run = vehgen.load_run("two_humps.yaml")
driven = vehgen.simulate(run)
driven.plot()

# %%
for name, values in ((channel.name, driven.channel(channel.name)) for channel in driven.channels):
    print(f"{name:14} largest {abs(values).max():.4g}")
for warning in driven.warnings:
    print("warning:", warning)

# %% [markdown]
# The tyre would leave the road: a linear tyre cannot, so the number is doubtful, and vehgen says so. A tyre that can
# leave it is a [force law](../force-laws.md).
