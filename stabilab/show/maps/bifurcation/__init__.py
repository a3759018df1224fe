"""A diagram of equilibria in words, numbers and pictures."""
