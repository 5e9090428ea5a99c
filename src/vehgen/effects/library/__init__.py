"""Which effects does vehgen know? One file an effect, or a few that are alike."""
