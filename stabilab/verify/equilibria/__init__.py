"""Claims about equilibria: curves, planes and points, whether they are all, and whether they are stable."""
