# %% [markdown]
# # A hidden effect
#
# A sedan crossed low and high humps. Its recordings hold something that the linear model of the file lacks. What,
# where, and how sure? The files are synthetic; the hidden law is told at the end.

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
import vehgen

runs = ["hidden/low_2ms.yaml", "hidden/high_4ms.yaml", "hidden/high_2.5ms.yaml"]

# %% [markdown]
# ## Does the model fit?

# %%
vehgen.validate("sedan2", runs).to_dataframe().query("`above noise`").head(8)

# %% [markdown]
# ## Diagnose
#
# The base model is refitted first: an effect is looked for in what no parameter explains. One run in three is kept from
# all fits. Nine candidates compete here, so that this page is made quickly; without `effects` it is the
# [whole library](../effects.md).

# %%
candidates = [
    "dry_friction",
    "cubic_stiffness",
    "bump_stop",
    "asymmetric_damping",
    "quadratic_damping",
    "hysteresis",
    "tyre_liftoff",
    "speed_error",
    "tyre_footprint",
]
diagnosis = vehgen.diagnose("sedan2", runs, effects=candidates)
print(diagnosis.verdict.verdict, "-", diagnosis.verdict.reason)

# %%
diagnosis

# %% [markdown]
# `chi` is the misfit over the noise: 1 is a perfect model. Before and after, run by run; the last one was not fitted
# to.

# %%
for run in diagnosis.verdict.gap.runs:
    print(f"{run.run:10} {'validation' if run.validation else 'fitted':11} chi {run.before:5.2f} -> {run.after:5.2f}")
for note in diagnosis.verdict.notes:
    print(note)

# %% [markdown]
# The places that an unknown force could act at, before any law is assumed: what remains when it acts there.

# %%
for place in diagnosis.verdict.places:
    print(f"{place.place:20} chi {place.chi:.3f}")

# %%
diagnosis.plot()

# %% [markdown]
# ## What it was
#
# Dry friction of 450 N in the rear suspension. [How to diagnose](../diagnose.md) says what else can be found and when
# nothing is named; [how often it is right](../hidden-effects.md) counts it over 75 cases.
