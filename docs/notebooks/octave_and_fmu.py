# %% [markdown]
# # To Octave and FMU
#
# The equations of motion go to other programs as data, as a MATLAB or Octave function, as C and as a co-simulation unit
# (FMI 2.0, 3.0). The numbers there are those of vehgen's own kernel, which this page checks. [All
# formats](../export.md).

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
import subprocess

import matplotlib.pyplot as plt
import numpy as np
import scipy.io
import scipy.linalg

import vehgen

# %% [markdown]
# ## A function for Octave and MATLAB

# %%
vehgen.export("tractor5", "m", "tractor5.m")
print("\n".join(Path("tractor5.m").read_text().splitlines()[:14]))

# %%
script = "model = tractor5(); printf('%.6f\\n', sort(sqrt(eig(model.K, model.M))) / (2*pi))"
octave = shutil.which("octave-cli") or shutil.which("octave")
if octave:
    print(subprocess.run([octave, "--no-gui", "--quiet", "--eval", script], capture_output=True, text=True, check=True).stdout)
else:
    print("no Octave here; in it, this prints the frequencies:", script, sep="\n")

# %% [markdown]
# The same as a MAT-file, read here by scipy, beside what vehgen says:

# %%
vehgen.export("tractor5", "mat", "tractor5.mat")
data = scipy.io.loadmat("tractor5.mat", squeeze_me=True)
there = np.sqrt(scipy.linalg.eigh(data["K"], data["M"], eigvals_only=True)) / (2 * np.pi)
here = [mode.undamped_hz for mode in vehgen.natural_modes("tractor5")]
print(np.column_stack([there, here]).round(6))
print("largest difference:", abs(there / here - 1).max())

# %% [markdown]
# ## A functional mock-up unit
#
# It holds sources and, where a C compiler is installed, a binary. FMPy drives it over a hump. The vehicle is a quarter
# car whose tyre has no damping, so that heights of the road are all that it feels; [damped
# tyres](../export.md#fmu-fmu3) feel rates, too.

# %%
quarter = vehgen.parse_vehicle("extends: quarter_car\nname: quarter\nparameters: {cT: {value: 0 N s/m}}")
vehgen.export(quarter, "fmu", "quarter_car.fmu")
from fmpy import read_model_description

description = read_model_description("quarter_car.fmu")
[(variable.name, variable.causality, variable.unit) for variable in description.modelVariables if variable.causality in ("input", "output")]

# %%
from fmpy import simulate_fmu

step = 1e-3
t = np.arange(0.0, 3.0, step)
road = np.where((t > 1.0) & (t < 1.1), 0.03 * np.sin(10 * np.pi * (t - 1.0)), 0.0)
signals = np.rec.fromarrays([t, road, np.diff(road, append=0.0) / step], names=["time", "road.axle1", "road.axle1.rate"])
driven = simulate_fmu("quarter_car.fmu", input=signals, step_size=step, output_interval=step)

# %% [markdown]
# The kernel over the same road:

# %%
source = vehgen.derive(quarter, [vehgen.PointOutput("az", vehgen.Place("cog", "body"), "acceleration")])
heights = road[:, None]
excitation = vehgen.Excitation(step, heights, np.zeros_like(heights), np.zeros((len(t), 0)))
kernel = vehgen.Kernel(source)
own = kernel.run(np.array([list(source.values().values())]), excitation, decimation=1).responses[0, :, 0]
figure, axes = plt.subplots(figsize=(7, 3))
axes.plot(t, own, label="kernel", linewidth=3, color="0.75")
axes.plot(driven["time"], driven["body_acceleration"], label="FMU by FMPy", linewidth=0.8)
axes.set(xlabel="time [s]", ylabel="acceleration of the body [m/s^2]", xlim=(0.9, 2.2))
axes.legend()
figure.tight_layout()

# %%
difference = abs(np.interp(t, driven["time"], driven["body_acceleration"]) - own).max() / abs(own).max()
print(f"largest difference over the largest acceleration: {difference:.1e}")
