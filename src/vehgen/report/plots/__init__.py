"""Which figure shows it? Figures of responses, imports, calibrations, validations and diagnoses."""
