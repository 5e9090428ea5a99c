"""Trials with hidden effects."""
