"""The effects that vehgen knows, one file each."""
