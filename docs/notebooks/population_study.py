# %% [markdown]
# # A population study with pandas
#
# How much do the peak acceleration of a tractor and the dynamic load of a tyre scatter over a fleet? The compiled kernel
# advances a whole population at once; pandas keeps the account.

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
import pandas as pd

import vehgen

# %% [markdown]
# ## A thousand tractors
#
# Springs, dampers and the load are drawn around what the file of `tractor5` says.

# %%
rng = np.random.default_rng(7)
nominal = vehgen.load_vehicle("tractor5").values()
spread = {"mS": 0.25, "k1": 0.10, "k2": 0.10, "c1": 0.30, "c2": 0.30, "kt1": 0.10}
fleet = pd.DataFrame({name: nominal[name] * np.exp(share * rng.standard_normal(1000)) for name, share in spread.items()})
fleet.describe().loc[["mean", "std", "min", "max"]].T

# %% [markdown]
# ## One hump, all of them
#
# A `Simulator` compiles the vehicle for what is to be computed; a scenario is the road under every wheel, at a speed.

# %%
Path("hump.yaml").write_text("""
vehicle: tractor5
speed: 5 m/s
duration: 5 s
sample: 5 ms
road: [{hump: {shape: half_sine, length: 0.5 m, height: 0.02 m, at: 2 m}}]
sensors: {driver: {body: tractor, behind: axle1, distance: 0.2 m, channels: {acceleration: az}}}
outputs: {front_load: {axle: axle1, quantity: tyre_load}}
""")
run = vehgen.load_run("hump.yaml")
simulator = vehgen.Simulator(run.vehicle, run.outputs())
scenario = vehgen.make_scenario(run, simulator.model, simulator.model.values())
driven = simulator.run(simulator.parameters(fleet.to_dict("records")), scenario)
driven.responses.shape  # (individuals, samples, channels)

# %% [markdown]
# ## What matters?

# %%
fleet["peak"] = abs(driven.responses[:, :, 0]).max(axis=1)
fleet["least_load"] = driven.responses[:, :, 1].min(axis=1)
fleet[["peak", "least_load"]].quantile([0.05, 0.5, 0.95])

# %% [markdown]
# Rank correlations tell which scatter is felt: the damper of axle 2 decides the peak over this hump, the front damper
# the least load of its own tyre; springs hardly matter. A load below zero, as a few have it, is a tyre that would leave the
# road, which a [linear tyre](../limits.md) cannot.

# %%
fleet.corr(method="spearman")[["peak", "least_load"]].drop(index=["peak", "least_load"]).round(2)

# %%
axes = fleet.plot.scatter("c2", "peak", c="mS", s=6, colormap="viridis", figsize=(7, 3.5))
axes.set_xlabel("damping of axle 2 [N s/m]")
axes.set_ylabel("peak acceleration [m/s^2]")
axes.figure.tight_layout()

# %% [markdown]
# ## A designed grid
#
# `groupby` and `pivot` serve as for any table: the peak, and what is left of the front tyre's load [kN], over both dampers.

# %%
factors = [0.5, 0.7, 1.0, 1.4, 2.0]
grid = pd.MultiIndex.from_product([factors, factors], names=["c1", "c2"]).to_frame(index=False)
driven = simulator.run(simulator.parameters((grid * [nominal["c1"], nominal["c2"]]).to_dict("records")), scenario)
peak, load = abs(driven.responses[:, :, 0]).max(axis=1), driven.responses[:, :, 1].min(axis=1) / 1e3
grid.assign(peak=peak, load=load).pivot(index="c1", columns="c2", values=["peak", "load"]).round(1)
