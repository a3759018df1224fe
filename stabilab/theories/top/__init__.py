"""The fast top in a Newtonian field, by a small parameter."""
