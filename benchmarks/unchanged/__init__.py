"""Records what a user computes, so that two states of the code can be compared number by number.

`results/0.1.0.json` holds what version 0.1.0 computed: natural modes and static loads of every bundled vehicle and parameter set;
responses over roads, with every force law and kind of input; populations in both precisions; cargo and advice; and the walks of
docs/diagnose.md, docs/silverbox.md and docs/calibrate.md. Only command lines are called, and a few names of `vehgen` in `response.py`
for what a CSV file rounds. Bits are equal on one kind of processor with the same libraries only, so record anew from a clone of the
older code where `compare` says that the machines differ.
"""
