"""What is missing? Detect, localise, name, add, verify."""
