"""From nothing to a road train over two humps: a script with the cells of a notebook."""

# %% [markdown]
# # From nothing to a road train over two humps, in Python
#
# The same steps as [tutorial.md](tutorial.md), with public names only. Run it in the folder of its files, [examples](examples).

# %%
import numpy as np

import vehgen

# %% [markdown]
# ## 1. A truck with two axles

# %%
truck = vehgen.load_vehicle("my_truck.yaml")
print(truck.title, list(truck.bodies), list(truck.axles))

modes = vehgen.natural_modes(truck)
for mode in modes:
    print(f"{mode.name:28}{mode.undamped_hz:9.4f}{mode.damped_hz:9.4f}{mode.damping_ratio:9.4f}")

loads = vehgen.static_loads(truck)
for name, force in loads.axles.items():
    print(f"{name}: {force:,.0f} N")

# %% [markdown]
# The equations of motion, symbolically and in numbers: M q'' + C q' + K q = P w + Q w' + F f.

# %%
model = vehgen.derive(truck)
print(model.M, model.K[0, 0])
numbers = model.numeric(model.values(overrides={"kf": 350e3}))
print(numbers.K.round(0))

# %% [markdown]
# In state space, with a ride height sensor above the front axle; and over frequency, at 15 m/s over one road.

# %%
driver = vehgen.Place("driver", "body", behind="front", distance=0.4)
comfort = [vehgen.PointOutput("driver_az", driver, "acceleration")]
system = vehgen.state_space(truck, outputs=comfort)
print(system.A.shape, system.inputs, system.outputs)
response = vehgen.frequency_response(truck, np.linspace(0.2, 25.0, 500), outputs=comfort, speed=15.0)
peak = response.frequency[np.abs(response.values[:, 0, 0]).argmax()]
print(f"the driver feels the road most at {peak:.1f} Hz")

# %% [markdown]
# The drawing, and the folder with equations, drawing, mode shapes, the compiled kernel, and one page with all of it.

# %%
vehgen.draw_vehicle(truck).savefig("my_truck.svg")
built = vehgen.build(truck, "build/my_truck")
print(built.operation_counts, built.warnings)

# %% [markdown]
# ## 2. A road train

# %%
train = vehgen.load_vehicle("my_road_train.yaml")
train_model = vehgen.derive(train)
print(train_model.n_dof, "degrees of freedom")
by_name = {mode.name: mode for mode in vehgen.natural_modes(train_model)}
cab = next(mode for name, mode in by_name.items() if name.startswith("cab heave"))
beam = next(mode for name, mode in by_name.items() if name.startswith("tridem pitch"))
print(f"the cab heaves at {cab.undamped_hz:.2f} Hz, the tridem beam rocks at {beam.undamped_hz:.1f} Hz")
print({name: round(force) for name, force in vehgen.static_loads(train_model).axles.items()})

# %% [markdown]
# ## 3. Over two humps

# %%
run = vehgen.load_run("two_humps.yaml")
driven = vehgen.simulate(run)
for channel in driven.channels:
    print(f"{channel.name:14}{channel.unit:8}{abs(driven.channel(channel.name)).max():12.5g}")
for text in driven.warnings:
    print("warning:", text)
driven.plot().savefig("response.png")

# %% [markdown]
# ## 4. A hundred vehicles in one kernel call

# %%
simulator = vehgen.Simulator(train, [vehgen.PointOutput("cab_az", vehgen.Place("driver", "cab"), "acceleration")])
scenario = vehgen.make_scenario(run, simulator.model, simulator.model.values())
population = simulator.parameters([{"k_trailer": 1.4e6 * factor} for factor in np.linspace(0.8, 1.2, 100)])
result = simulator.run(population, scenario)
print(result.responses.shape)  # (individuals, samples, channels)
