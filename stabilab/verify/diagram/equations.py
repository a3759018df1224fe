"""The equations of a diagram, as polynomials that are zero together, and how many real zeros they have at
a value of t.

Zeros are counted by a Groebner basis and Hermite's trace form, while t varies: the coefficients are
rational functions of t, or what these are at one algebraic value of it.

A polynomial is a table from the powers of its unknowns to coefficients that are not zero (`Ratio`,
`Residue`). The order of monomials is by total degree, then by the powers. Buchberger's algorithm: every pair
of the basis leaves the remainder zero, or its remainder joins the basis.

For any polynomial q Hermite's trace form with entries tr(b_i b_j q), over the monomials b that remain, has
the rank "different zeros at which q is not zero" and the signature "real ones where q > 0 less real ones
where q < 0". All its eigenvalues are real, so the signs of its characteristic polynomial's coefficients say
how many are positive (Descartes' rule is exact then).

The equations are rates, the law that holds along a motion, and where stability changes: flint's polynomials
in t and the three unknowns. A body's rates stand times its moments, w_i x_i' = kappa_i x_j x_k + rho_i x_k
+ sigma_i x_j + m_i with w = D (1 for the scaled system). Equilibria satisfy two linear conditions besides
(`verify.numbers.Rates`), which are sums of the rates."""
from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field
from itertools import product
from typing import Any

from flint import fmpq_mpoly, fmpq_mpoly_ctx, fmpq_poly

from ..numbers import AHEAD, written_out
from ..roots import Root, Work, bits
from .claims import Claims


@dataclass(frozen=True)
class Ratio:
    """top/bottom, polynomials in t without a common factor. Whoever divides by one notes its top: there the
    division fails."""

    top: fmpq_poly
    bottom: fmpq_poly
    work: Work = field(compare=False)

    @classmethod
    def of(cls, polynomial: fmpq_poly, work: Work) -> Ratio:
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


def _reduced(top: fmpq_poly, bottom: fmpq_poly, work: Work) -> Ratio:
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
        _, result, _ = self.value.xgcd(self.at)
        return Residue(result % self.at, self.at, self.work)

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


def _shifted(f: Polynomial, powers: Powers, c: Ratio) -> Polynomial:
    return {tuple(a + b for a, b in zip(old, powers)): value * c for old, value in f.items()}


def leading(f: Polynomial) -> Powers:
    """The greatest monomial."""
    return max(f, key=lambda powers: (sum(powers), powers))


def _divides(item: Powers, other: Powers) -> bool:
    return all(a <= b for a, b in zip(item, other))


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
        (item, f), (two, g) = self.members[n], self.members[k]
        both = tuple(map(max, item, two))
        raised = lambda h, top: {tuple(p + b - t for p, b, t in zip(powers, both, top)): c
                                 for powers, c in h.items()}
        return added(raised(f, item), raised(g, two), less=True)

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
        rows = [powers for powers in product(*map(range, ends))
                 if not any(_divides(top, powers) for top in tops)]
        return sorted(rows, key=lambda powers: (sum(powers), powers))


def characteristic(basis: Basis, monomials: Sequence[Powers], weight: Polynomial, item: Any) -> list[Any]:
    """Coefficients of the form's characteristic polynomial after the leading one, by Faddeev's recursion.
    weight: q, as `basis.rest` leaves it."""
    rows, size, zero = _form(basis, monomials, weight, item), len(monomials), item - item
    result: list[Any] = []
    power, last = [[zero] * size for _ in range(size)], item
    for n in range(1, size + 1):
        columns = list(zip(*power))
        power = [[sum((a * b for a, b in zip(row, column)), zero) for column in columns] for row in rows]
        power = [[value + c * last for value, c in zip(*both)] for both in zip(power, rows)]
        last = (zero - sum((power[k][k] for k in range(size)), zero)).over(n)
        result.append(last)
    return result


def _form(basis: Basis, monomials: Sequence[Powers], weight: Polynomial, item: Any) -> list[list[Any]]:
    """The matrix of tr(b_i b_j weight)."""
    zero = item - item
    product = lambda *factors: tuple(map(sum, zip(*factors)))
    fraction = lambda b, c: basis.rest({product(b, c): item}).get(c, zero)  # of c in b c
    traces = {b: sum((fraction(b, c) for c in monomials), zero) for b in monomials}

    def entry(a: Powers, b: Powers) -> Any:
        rest = basis.rest(times({product(a, b): item}, weight))
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
    retained = [s for s in signs if s]
    return sum(a != b for a, b in zip(retained, retained[1:]))


@dataclass(frozen=True)
class Equations:
    """weights: w_i; conditions, laws: two of each, a condition being the rate of a law a_i x_i^2/2 + b_i x_i;
    shift: of a plane of equilibria x_i = -shift_i, the scaled system's a about the first axis and zero
    else."""

    weights: list[fmpq_mpoly]
    rates: list[fmpq_mpoly]
    conditions: list[fmpq_mpoly]
    laws: tuple[fmpq_mpoly, fmpq_mpoly]
    shift: tuple[fmpq_mpoly, ...]
    scaled: bool

    @classmethod
    def of(cls, claims: Claims) -> Equations:
        """Those of a certificate's scene."""
        ring = fmpq_mpoly_ctx.get(("t", "x1", "x2", "x3"), "lex")
        t, *x = ring.gens()
        scene = {name: [_of_t(f, ring) for f in row] for name, row in claims.scene.items()}
        scaled, zero = claims.variables == "scaled", ring.constant(0)
        names = ("a", "b", "mu") if scaled else ("inertia", "momentum", "torque")
        weights, kappa, rho, sigma, m, conditions, laws = written_out(claims.variables,
                                                                      *(scene[name] for name in names))
        both = lambda u, v: sum((a * b for a, b in zip(u, v)), zero)
        rates = [kappa[i] * x[j] * x[k] + rho[i] * x[k] + sigma[i] * x[j] + m[i]
                 for i, (j, k) in enumerate(AHEAD)]
        first, second = (both(u, (v * v / 2 for v in x)) + both(w, x) for u, w in laws)
        return cls(weights, rates, [both(u, x) + c for u, c in conditions], (first, second),
                   (scene["a"][0] if scaled else zero, zero, zero), scaled)

    def slope(self, i: int, j: int) -> fmpq_mpoly:
        """The derivative of w_i x_i' by x_j."""
        return self.rates[i].derivative(j + 1)

    @property
    def m(self) -> fmpq_mpoly:
        """m of the characteristic polynomial z^3 + m z + n, times all weights."""
        zero = 0 * self.rates[0]
        return -sum((self.slope(j, k) * self.slope(k, j) * self.weights[i] for i, (j, k) in enumerate(AHEAD)),
                    zero)

    @property
    def n(self) -> fmpq_mpoly:
        """n of it, times all weights."""
        s = self.slope
        return -(s(0, 1) * s(1, 2) * s(2, 0) + s(0, 2) * s(1, 0) * s(2, 1))

    def torque(self, axis: int) -> Any:
        """Its part about an axis, in t alone: without any, equilibria lie on curves in other planes too."""
        return in_unknowns(self.rates[axis].subs({"x1": 0, "x2": 0, "x3": 0}), ()).get((), fmpq_poly([]))

    def along(self, axis: int) -> bool:
        """Whether all over the range the torque lies on principal axis `axis` (0, 1, 2) and no wheel along it
        keeps equilibria away: the rates and the conditions vanish in the plane across it but for the rate
        about it."""
        others = [f for n, f in enumerate(self.rates) if n != axis] + self.conditions
        return not any(self.across(axis, f) for f in others)

    def across(self, axis: int, f: fmpq_mpoly) -> Polynomial:
        """A polynomial in the plane across the axis where equilibria lie, in the two other unknowns."""
        places = list(f.context().gens())
        places[axis + 1] = -self.shift[axis]
        return in_unknowns(f.compose(*places, ctx=f.context()), [n for n in range(3) if n != axis])

    def kept(self, axis: int) -> fmpq_mpoly | None:
        """A sum of both laws that every motion keeps and that leaves the axis out of its squares; None where
        it is none."""
        first, second = ((1, -1), (0, 1), (1, 0))[axis] if self.scaled else (-self.weights[axis], 1)
        law = first * self.laws[0] + second * self.laws[1]
        return None if self.drift(law) else law

    def rise(self, law: fmpq_mpoly, start: Sequence[Any]) -> fmpq_mpoly:
        """A law less its value at a state whose components are polynomials in t."""
        ring = law.context()
        return law - law.compose(ring.gen(0), *(_of_t(f, ring) for f in start), ctx=ring)

    def drift(self, law: fmpq_mpoly) -> fmpq_mpoly:
        """The rate of a polynomial along every motion, times all weights."""
        w = self.weights
        return sum((law.derivative(i + 1) * self.rates[i] * w[j] * w[k] for i, (j, k) in enumerate(AHEAD)),
                   0 * law)


def _of_t(f: Any, ring: Any) -> fmpq_mpoly:
    """A polynomial in t as one in all variables."""
    return ring.from_dict({(n, 0, 0, 0): c for n, c in enumerate(f.coeffs()) if c != 0})


def in_unknowns(f: fmpq_mpoly, unknowns: Sequence[int] = range(3)) -> Polynomial:
    """As a table from the powers of some unknowns, which are all it has, to polynomials in t."""
    rows: dict[tuple[int, ...], dict[int, Any]] = {}
    for (power, *powers), c in f.to_dict().items():
        rows.setdefault(tuple(powers[n] for n in unknowns), {})[power] = c
    return {powers: fmpq_poly([row.get(n, 0) for n in range(max(row) + 1)]) for powers, row in rows.items()}


@dataclass(frozen=True)
class System:
    """Polynomials in the unknowns, with polynomials in t for coefficients. tests: others, whose signs at the
    zeros are asked. endless: a polynomial in t; where it is zero what is counted lies on more curves than
    these equations tell."""

    unknowns: int
    zero_together: Sequence[Polynomial]
    tests: Sequence[Polynomial] = ()
    endless: Any = None


@dataclass(frozen=True)
class Count:
    """At one value. real: different real zeros, None where zeros are endless; tests: for each, at how many of
    these it is positive less at how many it is negative, and whether it is zero nowhere, complex zeros
    counted."""

    real: int | None
    tests: tuple[tuple[int, bool], ...] = ()


def count_at(system: System, index: Root, work: Work) -> Count:
    """At a zero of a polynomial."""
    at = index.polynomial
    if system.endless is not None and system.endless % at == 0:
        return Count(None)
    return _counted(system, lambda c: Residue(c % at, at, work), lambda element: index.sign(element.value))[0]


def critical(system: System, work: Work) -> list[Any]:
    """Polynomials in t, not zero: between their real zeros every count is the same."""
    noted: list[Any] = []
    if system.endless == 0:
        return []
    _, basis = _counted(system, lambda c: Ratio.of(c, work), lambda element: 1, noted)
    return ([part for element in (*basis.pivots, *noted) for part in (element.top, element.bottom)]
            + ([] if system.endless is None else [system.endless]))


def _counted(system: System, lift: Callable[[Any], Any], sign: Callable[[Any], int],
             noted: list[Any] | None = None) -> tuple[Count, Basis]:
    """The count, and the basis it is worked out with. noted: collects the products of the eigenvalues that
    are not zero."""
    lifted = [{powers: e for powers, c in f.items() if (e := lift(c))} for f in system.zero_together]
    basis = Basis(lifted)
    monomials = basis.monomials(system.unknowns)
    if monomials is None:
        return Count(None), basis
    if not monomials:
        return Count(0, ((0, True),) * len(system.tests)), basis
    item = lift(fmpq_poly([1]))

    def judged(weight: Polynomial) -> tuple[int, int]:
        row = characteristic(basis, monomials, weight, item)
        rank, signature = rank_and_signature(row, sign)
        if noted is not None and rank:
            noted.append(row[rank - 1])
        return rank, signature
    different, real = judged({(0,) * system.unknowns: item})
    printed = []
    for test in system.tests:
        weight = basis.rest({powers: e for powers, c in test.items() if (e := lift(c))})
        rank, signature = judged(weight)
        printed.append((signature, rank == different))
    return Count(real, tuple(printed)), basis
