"""Times whole jobs, a command each in a process of its own, in turns with those of another checkout of the code."""
