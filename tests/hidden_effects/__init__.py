"""Tests of the trials with hidden effects."""
