"""Test rigs of the measured world: half cars that are dropped, dampers on a dynamometer, carriages on a rail.

They move by Newton's law with events at which dry friction begins to stick or to slip (`mechanism`); nothing here knows vehgen. `sets`
draws a case, `half_car`, `dyno` and `carriage` say what each family is, `hidden` what may be missing in its file and `strength` how clearly
it shows, `recorder` turns a motion into numbers, `files` writes what an engineer would hand over, `judging` says how an answer counts.
"""
