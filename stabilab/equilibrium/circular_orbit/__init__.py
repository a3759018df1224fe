"""Equilibria of a satellite with wheels on a circular orbit, in the orbital frame: all of them, exactly."""
