"""Endless growth by law: a torque along a principal axis that carries a gyrostatic component along it, too.
"""
