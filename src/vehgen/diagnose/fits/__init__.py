"""How well does a candidate fit? Fits of the base model and of candidate effects: first order, screening, several starts, restarts."""
