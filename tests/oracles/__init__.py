"""Independent answers: methods that share no code with stabilab (numpy, scipy, mpmath, heyoka only)."""
