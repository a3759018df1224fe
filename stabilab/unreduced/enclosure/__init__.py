"""Motions under a constant torque of any direction enclosed: sets that surely hold the state, at times and
between them."""
