"""Figures of responses, calibrations, validations and diagnoses."""
