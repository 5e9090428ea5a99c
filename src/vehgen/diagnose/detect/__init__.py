"""Is the model above the noise floor? Noise of every channel, the refitted base model, and harmonics."""
