"""Homoclinic loops, the branches they sweep, and the distance of a state from them."""
