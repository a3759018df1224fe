"""Spin-up under a torque of any direction, checked again: the way enclosed, the normal form and the inequality worked out anew."""
