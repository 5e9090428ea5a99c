"""The numbers by which a diagnosis decides; set on cases made for developing, and not moved afterwards.

chi is the root of the mean square of the whitened residuals: 1 is noise alone. An excess is chi^2 - 1.
"""

NOISE_FLOOR = 1.06
"""At or below this chi nothing is missing."""
WEAK = 1.12
"""Up to this chi something is there, but too weak to be named."""
PLACE_PASSES = 1.10
"""A place passes below this chi."""
PLACE_SHARE = 0.10
"""A place also passes when it leaves no more than this share of the excess without any unknown."""
PLACE_CLEAR = 0.01
"""A place that leaves no more than this share of the excess needs no second one."""
LAW_PASSES = 0.10
"""A law passes when it leaves no more than this share of the excess, on the training runs and on validation runs."""
LAW_CHI = 1.15
"""A law also passes below this chi."""
AT_LEAST = 0.5
"""A law leaves at most this share of the excess on the training runs, however near to the noise that is."""
TIE = 3.0
"""Candidates whose excess is within this factor of the best one's (and of the noise floor's) are tied with it."""
SIGNIFICANT = 0.01
"""Largest p-value, times the number of candidates tried, at which an effect counts as there."""
NAMED_LEFT = 2.0
"""An effect that leaves more than this chi, with nothing further found, is not named: what is left may be what was taken for it."""
AGAIN = 1.10
"""Above this chi a further effect is looked for."""
FORM = 0.005
"""A law may differ from the truth in form by this share of the gap's excess without a further effect being looked for."""
DECOY = 0.02
"""An effect must close this much more of the excess than the best of many random laws at its place."""
SEEDS = 2
"""So many effects that explain part of the gap are tried as the first of a pair."""
PARTLY = 0.85
"""An effect explains part of the gap when it leaves at most this share of the excess."""
CROWD = 2
"""A further effect with which more than this many others tie is not named."""
FURTHER = 0.25
"""A further effect must leave at most this share of the excess left before it."""
VALIDATION_FALL = 200.0
"""Validation runs that show no gap speak for an effect whose squares fall by so much with it, in -2 ln of the likelihood.

Laws fitted to vehicles that hid nothing took 174 off at most (docs/hidden-effects-sets.md)."""
FAINT_FALL, FAINT_VALIDATION = 150.0, 40.0
"""Where chi shows no gap, an effect is told that lets -2 ln of the likelihood fall by so much on the training runs, beyond the price of its
numbers, and by so much on the validation runs.

Of laws fitted to 90 vehicles that hid nothing some fell by up to 827 on the training runs, but none of these by more than 16 on the
validation runs."""
FAINT_TIE = 0.8
"""Candidates that let -2 ln L fall by this share of what the best one does, on training and on validation runs, are tied with it there."""
VARIED_SPEEDS = 1.25
"""Runs differ in speed where the fastest is driven so many times as fast as the slowest."""
