"""Permanent rotations in gravity, a Newtonian field, a turning charge."""
