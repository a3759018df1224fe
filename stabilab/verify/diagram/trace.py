"""Hermite's trace form: its rank is the number of different zeros of the equations, its signature that of the real ones.

For any polynomial q the form with entries tr(b_i b_j q), over the monomials b that remain, has the rank "different zeros at which q is not zero" and the
signature "real ones where q > 0 less real ones where q < 0". All its eigenvalues are real, so the signs of its characteristic polynomial's coefficients
tell how many are positive (Descartes' rule is exact then).
"""
from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

from .ideal import Basis, Polynomial, Powers, times


def characteristic(basis: Basis, monomials: Sequence[Powers], weight: Polynomial, one: Any) -> list[Any]:
    """Coefficients of the form's characteristic polynomial after the leading one, by Faddeev's recursion. weight: q, as `basis.rest` leaves it."""
    rows, size, zero = _form(basis, monomials, weight, one), len(monomials), one - one
    found: list[Any] = []
    power = [[zero] * size for _ in range(size)]
    last = one
    for n in range(1, size + 1):
        power = _product(rows, power, zero)
        for k in range(size):
            power[k] = [value + rows[k][m] * last for m, value in enumerate(power[k])]
        trace = zero
        for k in range(size):
            trace = trace + power[k][k]
        last = (zero - trace).over(n)
        found.append(last)
    return found


def _form(basis: Basis, monomials: Sequence[Powers], weight: Polynomial, one: Any) -> list[list[Any]]:
    """The matrix of tr(b_i b_j weight)."""
    zero = one - one
    product = lambda *factors: tuple(map(sum, zip(*factors)))
    traces = {}
    for b in monomials:
        total = zero
        for c in monomials:  # the share of c in b c
            total = total + basis.rest({product(b, c): one}).get(c, zero)
        traces[b] = total
    rows = []
    for a in monomials:
        row = []
        for b in monomials:
            total = zero
            for powers, c in basis.rest(times({product(a, b): one}, weight)).items():
                total = total + c * traces[powers]
            row.append(total)
        rows.append(row)
    return rows


def _product(a: list[list[Any]], b: list[list[Any]], zero: Any) -> list[list[Any]]:
    size = len(a)
    out = [[zero] * size for _ in range(size)]
    for i in range(size):
        for j in range(size):
            for k in range(size):
                out[i][j] = out[i][j] + a[i][k] * b[k][j]
    return out


def rank_and_signature(coefficients: Sequence[Any], sign: Callable[[Any], int]) -> tuple[int, int]:
    """(rank, positive eigenvalues less negative ones), given the signs of the coefficients after the leading one."""
    signs = [1, *(sign(c) if c else 0 for c in coefficients)]
    rank = max(n for n, s in enumerate(signs) if s)
    plus = _changes(signs)
    minus = _changes([s if n % 2 == 0 else -s for n, s in enumerate(signs)])
    return rank, plus - minus


def _changes(signs: Sequence[int]) -> int:
    kept = [s for s in signs if s]
    return sum(a != b for a, b in zip(kept, kept[1:]))
