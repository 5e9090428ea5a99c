"""Tests of benchmarks/limits."""
