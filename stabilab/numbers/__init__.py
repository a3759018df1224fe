"""Numbers that know their error: exact rationals, balls of doubles and of many digits, boxes, polynomials, roots. No mechanics."""
