"""Which parameters? Hump calibration (SHCM, DHCM, joint), intervals, identifiability, sensitivities, sensor placement, validation."""
