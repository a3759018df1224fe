"""Turning points, and the ranges of the rates between them."""
