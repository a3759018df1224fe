"""Printed formulas as data, and as functions."""
