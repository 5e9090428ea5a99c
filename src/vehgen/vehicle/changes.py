"""A change laid over a vehicle, as a file lays it over the one that it extends."""

from __future__ import annotations

from vehgen.errors import InputError, did_you_mean, shown
from vehgen.files.document import Located


def merge(base: Located, change: Located) -> Located:
    """Lay `change` over `base`: mappings merge key by key, null removes, everything else replaces."""
    if not (isinstance(base.value, dict) and isinstance(change.value, dict)):
        return change
    kept = dict(base.value)
    for clash, other in (("equals", ("value", "range")), ("value", ("equals",))):
        if clash in change.value and not isinstance(change.value[clash].value, dict):
            kept = {key: item for key, item in kept.items() if key not in other}
    for key, item in change.value.items():
        if item.value is None:
            if key not in kept:
                removal = "None removes" if item.position.is_argument else "null removes"
                lacking = "the vehicle has none" if item.position.is_argument else "the file it extends has none"
                raise InputError(f"{removal} {shown(key)}, but {lacking}; {did_you_mean(key, kept)}", item.key_position)
            del kept[key]
        else:
            kept[key] = merge(kept[key], item) if key in kept else item
    return Located(kept, change.position, change.key_position)
