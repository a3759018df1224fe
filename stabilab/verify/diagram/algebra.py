"""How many real zeros equations have, by a Groebner basis and Hermite's trace form, while a number t varies:
their coefficients are rational functions of t, or what these are at one algebraic value of it.

A polynomial is a table from the powers of its unknowns to coefficients that are not zero (`Ratio`,
`Residue`). The order of monomials is by total degree, then by the powers. Buchberger's algorithm: every pair
of the basis leaves the remainder zero, or its remainder joins the basis.

For any polynomial q Hermite's trace form with entries tr(b_i b_j q), over the monomials b that remain, has
the rank "different zeros at which q is not zero" and the signature "real ones where q > 0 less real ones
where q < 0". All its eigenvalues are real, so the signs of its characteristic polynomial's coefficients tell
how many are positive (Descartes' rule is exact then). """
from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field
from itertools import product
from typing import Any

from flint import fmpq_poly

from ..roots import Work, bits


@dataclass(frozen=True)
class Ratio:
    """top/bottom, polynomials in t without a common factor. Whoever divides by one notes its top: there the
    division fails."""

    top: fmpq_poly
    bottom: fmpq_poly
    work: Work = field(compare=False)

    @classmethod
    def of(cls, polynomial, work: Work) -> Ratio:
        """A polynomial in t."""
        return cls(polynomial, polynomial * 0 + 1, work)

    def __bool__(self) -> bool:
        return self.top != 0

    def __add__(self, other: Ratio) -> Ratio:
        return _reduced(self.top * other.bottom + other.top * self.bottom, self.bottom * other.bottom,
                        self.work)

    def __sub__(self, other: Ratio) -> Ratio:
        return _reduced(self.top * other.bottom - other.top * self.bottom, self.bottom * other.bottom,
                        self.work)

    def __mul__(self, other: Ratio) -> Ratio:
        return _reduced(self.top * other.top, self.bottom * other.bottom, self.work)

    def inverse(self) -> Ratio:
        """1 over it; it is not zero."""
        return _reduced(self.bottom, self.top, self.work)

    def over(self, whole: int) -> Ratio:
        """It, over a whole number."""
        return Ratio(self.top / whole, self.bottom, self.work)


def _reduced(top, bottom, work: Work) -> Ratio:
    work.common(top, bottom)
    common = top.gcd(bottom)
    lead = (bottom / common).leading_coefficient()
    return Ratio(top / common / lead, bottom / common / lead, work)


@dataclass(frozen=True)
class Residue:
    """What a polynomial in t is at a zero of an irreducible one, `at`: of degree one at a rational value."""

    value: fmpq_poly
    at: fmpq_poly
    work: Work = field(compare=False)

    def __bool__(self) -> bool:
        return self.value != 0

    def __add__(self, other: Residue) -> Residue:
        return Residue(self.value + other.value, self.at, self.work)

    def __sub__(self, other: Residue) -> Residue:
        return Residue(self.value - other.value, self.at, self.work)

    def __mul__(self, other: Residue) -> Residue:
        product = self.value * other.value
        self.work.division(product, self.at)
        return Residue(product % self.at, self.at, self.work)

    def inverse(self) -> Residue:
        """1 over it; it is not zero."""
        self.work.spend((1 + self.at.degree()) * (bits(self.value) + bits(self.at)))
        self.work.division(self.value, self.at)
        _, found, _ = self.value.xgcd(self.at)
        return Residue(found % self.at, self.at, self.work)

    def over(self, whole: int) -> Residue:
        """It, over a whole number."""
        return Residue(self.value / whole, self.at, self.work)


Powers = tuple[int, ...]
Polynomial = dict[Powers, Any]


def added(f: Polynomial, g: Polynomial, less: bool = False) -> Polynomial:
    """f + g, or f - g."""
    out = dict(f)
    for powers, c in g.items():
        old = out.pop(powers, None)
        new = (c - c) - c if old is None and less else c if old is None else old - c if less else old + c
        if new:
            out[powers] = new
    return out


def times(f: Polynomial, g: Polynomial) -> Polynomial:
    """f g."""
    out: Polynomial = {}
    for powers, c in g.items():
        out = added(out, _shifted(f, powers, c))
    return out


def _shifted(f: Polynomial, powers: Powers, c: Any) -> Polynomial:
    return {tuple(a + b for a, b in zip(old, powers)): value * c for old, value in f.items()}


def leading(f: Polynomial) -> Powers:
    """The greatest monomial."""
    return max(f, key=lambda powers: (sum(powers), powers))


def _divides(one: Powers, other: Powers) -> bool:
    return all(a <= b for a, b in zip(one, other))


class Basis:
    """A Groebner basis of polynomials that are zero together. pivots: the elements that were divided by;
    wherever none of them is zero the same basis, with what its coefficients are there, is one."""

    def __init__(self, given: Iterable[Polynomial]):
        self.pivots: list[Any] = []
        self.members: list[tuple[Powers, Polynomial]] = []
        waiting = [f for f in given if f]
        pairs: list[tuple[int, int]] = []
        while waiting or pairs:
            f = self.rest(waiting.pop(0) if waiting else self._against(*pairs.pop(0)))
            if f:
                top = leading(f)
                self.pivots.append(f[top])
                scale = f[top].inverse()
                self.members.append((top, {powers: c * scale for powers, c in f.items()}))
                last = len(self.members) - 1
                pairs += [(n, last) for n in range(last)
                          if any(a and b for a, b in zip(self.members[n][0], top))]
                pairs.sort(key=lambda pair: sum(map(max, self.members[pair[0]][0], self.members[pair[1]][0])))

    def _against(self, n: int, k: int) -> Polynomial:
        """Two members, each raised to the least monomial that both leading ones divide, the one less the
        other."""
        (one, f), (two, g) = self.members[n], self.members[k]
        both = tuple(map(max, one, two))
        raised = lambda h, top: {tuple(p + b - t for p, b, t in zip(powers, both, top)): c
                                 for powers, c in h.items()}
        return added(raised(f, one), raised(g, two), less=True)

    def rest(self, f: Polynomial) -> Polynomial:
        """What remains of f: a sum of monomials that no leading one divides."""
        todo, out = dict(f), {}
        while todo:
            top = leading(todo)
            member = next((m for m in self.members if _divides(m[0], top)), None)
            if member is None:
                out[top] = todo.pop(top)
            else:
                todo = added(todo, _shifted(member[1], tuple(a - b for a, b in zip(top, member[0])),
                                            todo[top]), less=True)
        return out

    def monomials(self, unknowns: int) -> Sequence[Powers] | None:
        """Those that no leading one divides, rising: as many as there are zeros, each counted as often as it
        counts. None where these are endless."""
        tops = [top for top, _ in self.members]
        ends = []
        for n in range(unknowns):
            pure = [top[n] for top in tops if not any(p for k, p in enumerate(top) if k != n)]
            if not pure:
                return None
            ends.append(min(pure))
        found = [powers for powers in product(*map(range, ends))
                 if not any(_divides(top, powers) for top in tops)]
        return sorted(found, key=lambda powers: (sum(powers), powers))


def characteristic(basis: Basis, monomials: Sequence[Powers], weight: Polynomial, one: Any) -> list[Any]:
    """Coefficients of the form's characteristic polynomial after the leading one, by Faddeev's recursion.
    weight: q, as `basis.rest` leaves it."""
    rows, size, zero = _form(basis, monomials, weight, one), len(monomials), one - one
    found: list[Any] = []
    power, last = [[zero] * size for _ in range(size)], one
    for n in range(1, size + 1):
        columns = list(zip(*power))
        power = [[sum((a * b for a, b in zip(row, column)), zero) for column in columns] for row in rows]
        power = [[value + c * last for value, c in zip(*both)] for both in zip(power, rows)]
        last = (zero - sum((power[k][k] for k in range(size)), zero)).over(n)
        found.append(last)
    return found


def _form(basis: Basis, monomials: Sequence[Powers], weight: Polynomial, one: Any) -> list[list[Any]]:
    """The matrix of tr(b_i b_j weight)."""
    zero = one - one
    product = lambda *factors: tuple(map(sum, zip(*factors)))
    share = lambda b, c: basis.rest({product(b, c): one}).get(c, zero)  # of c in b c
    traces = {b: sum((share(b, c) for c in monomials), zero) for b in monomials}

    def entry(a: Powers, b: Powers) -> Any:
        rest = basis.rest(times({product(a, b): one}, weight))
        return sum((c * traces[powers] for powers, c in rest.items()), zero)
    return [[entry(a, b) for b in monomials] for a in monomials]


def rank_and_signature(coefficients: Sequence[Any], sign: Callable[[Any], int]) -> tuple[int, int]:
    """(rank, positive eigenvalues less negative ones), given the signs of the coefficients after the leading
    one."""
    signs = [1, *(sign(c) if c else 0 for c in coefficients)]
    rank = max(n for n, s in enumerate(signs) if s)
    plus = _changes(signs)
    minus = _changes([s if n % 2 == 0 else -s for n, s in enumerate(signs)])
    return rank, plus - minus


def _changes(signs: Sequence[int]) -> int:
    kept = [s for s in signs if s]
    return sum(a != b for a, b in zip(kept, kept[1:]))
