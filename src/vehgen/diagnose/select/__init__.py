"""Which effect explains the gap? The search over candidates, the criteria, estimates and placebo laws."""
