"""Polynomials with rational coefficients in python-flint: do two share a root?"""
from __future__ import annotations

from fractions import Fraction
from typing import TYPE_CHECKING

from .balls import rational, real_roots_of
from .vectors import Number

if TYPE_CHECKING:
    from flint import arb, fmpq_poly


def polynomial(*coefficients: Number) -> fmpq_poly:
    """flint's polynomial with these rational coefficients, lowest power first."""
    from flint import fmpq_poly
    return fmpq_poly([rational(Fraction(c)) for c in coefficients])


def shares_root(first: fmpq_poly, second: fmpq_poly, root: arb) -> bool:
    """Whether the root (a ball that isolates it among those of `first`) is one of `second` as well; flint's polynomials."""
    common = first.gcd(second)
    return any(z.overlaps(root) for z, _ in real_roots_of(common))
