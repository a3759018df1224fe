"""A satellite on a circular orbit: its equilibria in the orbital frame."""
