"""What to measure next? Candidate runs, what fitted models predict for them, and a proposal."""
