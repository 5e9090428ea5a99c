"""Fits of the base model and of candidate effects."""
