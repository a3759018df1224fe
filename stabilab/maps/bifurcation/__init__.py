"""Diagrams of equilibria over one or two numbers of a case: exact, by elimination, with no step along the
way."""
