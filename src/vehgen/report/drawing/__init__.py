"""What does it look like? The vehicle, its mode shapes and its modules, drawn to scale."""
