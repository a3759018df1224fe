"""Plots in the space of rates."""
