"""Runs in time: one motion by Taylor series or SciPy, ensembles, every extremum along a run, the same in many
digits."""
