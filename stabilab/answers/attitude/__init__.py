"""How a motion turns in space."""
