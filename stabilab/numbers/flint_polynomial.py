"""Polynomials with rational coefficients in python-flint: do two share a root?"""
from __future__ import annotations

from fractions import Fraction

from .balls import rational


def polynomial(*coefficients):
    """flint's polynomial with these rational coefficients, lowest power first."""
    from flint import fmpq_poly
    return fmpq_poly([rational(Fraction(c)) for c in coefficients])


def shares_root(first, second, root) -> bool:
    """Whether the root (a ball that isolates it among those of `first`) is one of `second` as well; flint's polynomials."""
    common = first.gcd(second)
    return common.degree() > 0 and any(z.imag.is_zero() and z.real.overlaps(root) for z, _ in common.complex_roots())
