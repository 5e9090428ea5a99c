# %% [markdown]
# # From phones to a calibrated truck
#
# Two phones in a five-axle tractor-semitrailer recorded how it crossed a hump at 2 and at 3 m/s. Their exports become
# run files, the run files a calibrated vehicle. The recordings are synthetic: a truck whose parameters are 2 to 6 % off
# the file's made them, so the answer can be checked. [The long walk](../calibrate.md) has the same files, a larger
# search, and what a weighbridge adds.

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
import sys

import matplotlib.pyplot as plt
import pandas as pd

import vehgen

# %% [markdown]
# ## Import
#
# Each phone is told where it lay and which of its axes pointed forward. Tilt, gravity and clocks are found from the
# recordings.

# %%
sensors = [
    vehgen.PhoneSensor("L1", "tractor", behind="axle1", distance=-0.29, forward="y"),
    vehgen.PhoneSensor("L2", "semitrailer", behind="fifth_wheel", distance=9.115, forward="x"),
]
hump = {"shape": "half_sine", "length": 0.5, "height": 0.03}
imported = {}
for name in ("hump_2ms", "hump_3ms"):
    exports = [f"phones/{name}_phone{number}.zip" for number in (1, 2)]
    imported[name] = vehgen.import_phones(exports, vehicle="tractor5", sensors=sensors, hump=hump, out=f"{name}.yaml")
imported["hump_2ms"]

# %%
recorded = pd.read_csv("hump_2ms_recording.csv", comment="#")
recorded.plot(x=recorded.columns[0], subplots=True, figsize=(7, 5), linewidth=0.7)
plt.tight_layout()

# %% [markdown]
# ## Calibrate, with a weighbridge
#
# Recordings over a road cannot tell a truck from one that has twice its masses, springs and dampers: both move alike. A
# weighbridge can, so its numbers go along, as facts. The search is small here, so that this page is made quickly; the
# defaults take larger populations and more starts.

# %%
print(Path("phones/facts.yaml").read_text())

# %%
runs = ["hump_2ms.yaml", "hump_3ms.yaml"]
calibrated = vehgen.calibrate("tractor5", runs, facts="phones/facts.yaml", size=30, generations=20, starts=2)
calibrated

# %% [markdown]
# ## Check against the truth
#
# The script that made the recordings knows it; vehgen has not seen it.

# %%
sys.path.insert(0, "phones")
from make_exports import FILE, MT, OFF

lengths = ("a1", "a2", "b1", "b6")
truth = pd.Series({name: FILE[name] * OFF[name] * (1.0 if name in lengths else MT) for name in FILE})
table = calibrated.to_dataframe().set_index("parameter")
table["error of the file [%]"] = 100 * (pd.Series(vehgen.load_vehicle("tractor5").values()) / truth - 1)
table["error now [%]"] = 100 * (table["value"] / truth - 1)
table["interval holds it"] = table["low"].le(truth) & table["high"].ge(truth)
table[["value", "unit", "low", "high", "error of the file [%]", "error now [%]", "interval holds it"]].round(4)

# %%
errors = table[["error of the file [%]", "error now [%]"]].abs()
print(errors.median().round(2))
print(f"{table['interval holds it'].sum()} of {len(table)} intervals of 90 % hold the truth")

# %% [markdown]
# A road that was not used for the fit is the next check, [as the walk does it](../calibrate.md).

# %%
calibrated.plot()
