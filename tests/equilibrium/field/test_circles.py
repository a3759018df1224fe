"""Tests of `equilibrium/field/circles.py`: what once went wrong there, and its edges."""
from __future__ import annotations


def test_equal_stiffness_is_found_at_every_rate_or_none():
    """By substitution in (Omega^2 - N)(D_i - D_j) = Omega E, axis 3 carrying E."""
    from fractions import Fraction
    from types import SimpleNamespace

    from stabilab.equilibrium.field_states import _same_stiffness
    parts = SimpleNamespace(D=(Fraction(2), Fraction(2), Fraction(3)), N=Fraction(1), E=Fraction(3))
    assert _same_stiffness(parts, 0, 1) == [0]  # equal moments: the same at every rate
    for Omega in _same_stiffness(parts, 0, 2):
        assert abs((Omega**2 - parts.N) * (parts.D[0] - parts.D[2]) + Omega * parts.E) < Fraction(1, 2**200)
    assert len(_same_stiffness(parts, 0, 2)) == 2
    pulled = SimpleNamespace(D=parts.D, N=Fraction(-4), E=Fraction(3))  # Omega^2 - 3 Omega + 4 has no real root
    assert _same_stiffness(pulled, 0, 2) == []
