"""How a motion turns in space: what is known of it, and what takes a run or Lagrange's cubic."""
