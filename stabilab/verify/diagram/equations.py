"""What is counted, as polynomials that are zero together, and how many real zeros these have at a value of t.

They are rates, the law that a motion keeps, and where stability changes: flint's polynomials in t and the
three unknowns. A body's rates stand times its moments, w_i x_i' = kappa_i x_j x_k + rho_i x_k + sigma_i x_j +
m_i with w = D (1 for the scaled system). Equilibria satisfy two linear conditions besides (`rates.Rates`),
which are sums of the rates.
"""
from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

from flint import fmpq_mpoly, fmpq_mpoly_ctx, fmpq_poly

from ..rates import AHEAD, written_out
from ..roots import Root, Work
from .algebra import Basis, Polynomial, Ratio, Residue, characteristic, rank_and_signature
from .claims import Claims


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


def count_at(system: System, place: Root, work: Work) -> Count:
    """At a zero of a polynomial."""
    at = place.polynomial
    if system.endless is not None and system.endless % at == 0:
        return Count(None)
    return _counted(system, lambda c: Residue(c % at, at, work), lambda element: place.sign(element.value))[0]


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
    one = lift(fmpq_poly([1]))

    def judged(weight: Polynomial) -> tuple[int, int]:
        row = characteristic(basis, monomials, weight, one)
        rank, signature = rank_and_signature(row, sign)
        if noted is not None and rank:
            noted.append(row[rank - 1])
        return rank, signature
    different, real = judged({(0,) * system.unknowns: one})
    told = []
    for test in system.tests:
        weight = basis.rest({powers: e for powers, c in test.items() if (e := lift(c))})
        rank, signature = judged(weight)
        told.append((signature, rank == different))
    return Count(real, tuple(told)), basis
