"""Blind trials: recordings of vehicles with a hidden effect, made by a simulator that shares no code with vehgen."""
