"""How well does it fit? Recordings, trials, searched parameters, noise, whitened residuals and least squares."""
