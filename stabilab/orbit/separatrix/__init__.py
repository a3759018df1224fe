"""Homoclinic loops, the sheets they sweep, and the distance of a state from them."""
