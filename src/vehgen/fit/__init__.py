"""How well does it fit? Trials, searched parameters, noise, whitened residuals and least squares."""
