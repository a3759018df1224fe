"""The field of an algebraic number, and polynomials over it."""
