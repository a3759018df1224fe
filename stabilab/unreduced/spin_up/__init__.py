"""Spin-up under a constant torque of any direction: normal forms about an axis, an inequality that stays
true, its search."""
