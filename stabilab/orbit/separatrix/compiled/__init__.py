"""Sheets of the separatrix as straight lines of floats, which numba compiles."""
