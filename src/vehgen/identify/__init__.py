"""Which parameters? Calibration of vehicles from recordings over humps and roads."""
