"""Equilibria of bodies with a cavity of liquid or in a resisting medium."""
