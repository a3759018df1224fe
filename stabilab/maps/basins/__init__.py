"""Basins: which fate the motions from a plane of initial states have, with cells that get smaller towards the
boundary."""
