"""Which effects does vehgen know? One file an effect."""
