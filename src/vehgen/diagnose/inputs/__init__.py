"""Is the measurement what it is said to be? Checks of recordings, and hypotheses of mistakes, each undone and judged by a refit.

A mistake of channels, sensors, clocks, runs, humps or vehicle is suspected where a cheap comparison with the file's prediction gives
reason, and told where the base model, fitted again with it undone, closes the gap.
"""
