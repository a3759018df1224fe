"""Numbers that know their error: exact rationals, balls, boxes, polynomials, roots. No mechanics."""
