"""How far kernels are from what a machine can do, and from those of another checkout."""
