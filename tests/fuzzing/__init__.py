"""Files from strangers: a seeded fuzzer of every kind of file that vehgen reads, and the corpus of the nastiest."""
