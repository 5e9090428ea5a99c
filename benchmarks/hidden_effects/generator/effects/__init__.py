"""The effects by name."""

from benchmarks.hidden_effects.generator.effects.kind import EffectKind, Value
from benchmarks.hidden_effects.generator.effects.measurement import MEASUREMENT
from benchmarks.hidden_effects.generator.effects.structure import STRUCTURE
from benchmarks.hidden_effects.generator.effects.suspension import SUSPENSION
from benchmarks.hidden_effects.generator.effects.tyre_and_hinge import TYRE_AND_HINGE
from benchmarks.hidden_effects.generator.effects.unlisted import UNLISTED

EFFECTS: dict[str, EffectKind] = {kind.name: kind for kind in (*SUSPENSION, *TYRE_AND_HINGE, *STRUCTURE, *MEASUREMENT, *UNLISTED)}

__all__ = ["EFFECTS", "EffectKind", "Value"]
