"""A world in which recordings come about as real ones do, independent of vehgen, to judge its diagnoses and calibrations.

A driver's speed wanders, humps are not quite as stated, roads are rough where nobody measured them, phones lie tilted and have filters,
clocks and noise of their own, loggers decimate, and sometimes a plain mistake is made. Test rigs (`rigs`) are
dropped, moved and pushed. Only solve.py knows vehgen, by its public names; the vehicles share the mechanics of benchmarks/hidden_effects
(Newton and Euler with explicit pin forces).
"""
