"""Permanent rotations omega = Omega gamma of a body in a field at one rate Omega, with spectrum and verdict,
and the rates at which their number or a sign of their spectrum may change.

On |gamma| = 1 the amended potential at constant Omega is U = -gamma . S gamma/2 - b . gamma with
S = (Omega^2 - N) D - Omega E e3 e3^T, b = Omega Lambda + s; a permanent rotation is a critical point, (S -
mu) gamma = -b. At constant area integral A it gains a positive term of rank one: its second variation on the
tangent plane is K = mu - S + v v^T/I with v = dU'/dOmega = -(S' gamma + Lambda), I = gamma . D gamma.
Linear motion: z^2 (z^4 + a z^2 + b), the two zeros from |gamma| and from the curve of permanent rotations;
a = -tr(J^2)/2 and b = I det K/(D1 D2 D3).
  K positive definite: stable (energy at constant area has a strict minimum, and it persists as the area
  changes). det K < 0: b < 0, a positive eigenvalue.
  K negative definite: the spectrum decides instability; where it is a centre (a > 0, a^2 > 4 b) energy does
  not decide.
Written for any scalars, with gamma as a ratio gamma/q, so that the same lines serve balls and polynomials.

All rotations at one Omega are roots mu of one polynomial, and signs of certified balls give the verdict on
each. The rates at which that changes are real roots of the discriminants of the polynomial's irreducible
factors in mu, and of their resultants with b, with a^2 - 4 b, and with a where one of these vanishes all
along a branch (as a^2 - 4 b does where D3 = 2 D1): polynomials in Omega with exact coefficients, whose real
roots python-flint isolates. A sleeping top is decided by Lagrange's cubic besides, whatever vanishes."""
from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from itertools import combinations
from typing import Any

from flint import Ordering, acb, arb, fmpq, fmpq_mpoly_ctx, fmpq_poly

from ..numbers.algebraic import univariate
from ..numbers.balls import MANY_BITS, rational, working
from ..numbers.polynomial import Poly, real_roots
from ..numbers.vectors import Number, cross, cross_matrix, dot
from ..physics.coefficients import linear_rates
from ..reasons import Sentence
from .result import EquilibriumPoint, Verdict


@dataclass(frozen=True)
class Field:
    """The coefficients of a `Content` as flint rationals."""

    D: tuple
    Lambda: tuple
    s: tuple
    N: Number
    E: Number

    @classmethod
    def of(cls, parts):
        return cls(*(tuple(map(rational, row)) for row in (parts.D, parts.Lambda, parts.s)),
                   rational(parts.N), rational(parts.E))

    def stiffness(self, Omega):
        """Diagonal of S."""
        W = Omega * Omega - self.N
        return (W * self.D[0], W * self.D[1], W * self.D[2] - Omega * self.E)

    def pull(self, Omega):
        """b = Omega Lambda + s."""
        return tuple(Omega * l + s for l, s in zip(self.Lambda, self.s))


def second_variation(field: Field, Omega, mu, gamma, q=1):
    """(q^4 I det K, q^4 I tr K) at gamma/q."""
    n = [k - mu for k in field.stiffness(Omega)]
    slope = (Omega * 2 * field.D[0], Omega * 2 * field.D[1], Omega * 2 * field.D[2] - field.E)
    v = [-(d * g + q * l) for d, g, l in zip(slope, gamma, field.Lambda)]
    squares = [g * g for g in gamma]
    spread = dot(field_inertia(field, gamma), gamma)
    plane = n[1] * n[2] * squares[0] + n[2] * n[0] * squares[1] + n[0] * n[1] * squares[2]
    across = cross(v, gamma)
    determinant = (spread * plane - sum((n[i] * across[i] * across[i] for i in range(1, 3)),
                                        n[0] * across[0] * across[0]))
    trace = dot(across, across) - spread * dot(n, [q * q - x for x in squares])
    return determinant, trace


def field_inertia(field: Field, gamma):
    """D gamma."""
    return tuple(g * d for d, g in zip(field.D, gamma))


def blocks(field: Field, Omega, gamma, q=1):
    """Rows of q A, q B with delta omega' = A delta omega + B delta gamma at gamma/q."""
    omega = tuple(Omega * g for g in gamma)
    H = [w * d + q * l for d, w, l in zip(field.D, omega, field.Lambda)]
    H[2] = H[2] - gamma[2] * field.E
    A = linear_rates(field.D, omega, H)
    spread = field_inertia(field, gamma)
    s, turn, turned = map(cross_matrix, ([q * x for x in field.s], gamma, spread))
    B = [[(s[i][j] + (turn[i][j] * field.D[j] - turned[i][j]) * field.N) * (1 / field.D[i])
          for j in range(3)] for i in range(3)]  # of s x gamma + N gamma x D gamma
    B[0][2] = B[0][2] + omega[1] * (field.E / field.D[0])   # E g3 omega x e3
    B[1][2] = B[1][2] - omega[0] * (field.E / field.D[1])
    return A, B


def coefficients(field: Field, Omega, mu, gamma, q=1):
    """(q^2 a, q^4 b) of z^4 + a z^2 + b."""
    A, B = blocks(field, Omega, gamma, q)
    turn = cross_matrix(gamma)
    pairs = [(i, j) for i in range(3) for j in range(3)]
    square = sum((A[i][j] * A[j][i] + B[i][j] * turn[j][i] * 2 for i, j in pairs), gamma[0] * 0)
    a = Omega * Omega * q * q - square * fmpq(1, 2)
    determinant, _ = second_variation(field, Omega, mu, gamma, q)
    return a, determinant * (1 / (field.D[0] * field.D[1] * field.D[2]))


@dataclass(frozen=True)
class Rotation:
    """One solution at one Omega: mu and gamma as balls; circle: it stands for all its turns about axis 3 (or
    its own)."""

    mu: Number
    gamma: tuple
    circle: tuple = ()


def groups_at(S, b):
    """[(axes of one value of S, whether b vanishes there)] for exact S, b."""
    first = [k for k in range(3) if not any(S[k] == S[n] for n in range(k))]
    groups = [[i for i in range(3) if S[i] == S[k]] for k in first]
    return [(axes, not any(b[i] != 0 for i in axes)) for axes in groups]


def rotations_at(field: Field, Omega: Fraction) -> list[Rotation]:
    """All permanent rotations with this Omega (exact), those of the polynomial first, rising in mu."""
    O = rational(Omega)
    S, b = field.stiffness(O), field.pull(O)
    parted = groups_at(S, b)
    acting = [axes for axes, idle in parted if not idle]
    rows = []
    if acting:
        mu = fmpq_poly([0, 1])
        n = {axes[0]: S[axes[0]] - mu for axes in acting}
        P = secular(acting, n, b, fmpq_poly([1]))
        rows += _directions(P, S, b, acting)
    for axes, idle in parted:
        if idle:
            rows += _free_part(axes, acting, S, b, fmpq(1), arb)
    return rows


def _directions(P, S, b, acting) -> list[Rotation]:
    """gamma_i = -b_i/(S_i - mu) at every real root mu of P, rising; with more digits where b is so small that
    S_i - mu has none left."""
    for bits in (MANY_BITS, 4 * MANY_BITS, 16 * MANY_BITS):
        with working(bits):
            rows = []
            for root in sorted((r.real for r, _ in P.numer().complex_roots() if r.imag == 0),
                               key=lambda r: r.mid()):
                gamma = [arb(0)] * 3
                for axes in acting:
                    for i in axes:
                        gamma[i] = -b[i] / (S[i] - root)
                rows.append(Rotation(root, tuple(gamma)))
        if all(g.is_finite() and g.rad() < 1e-40 for rotation in rows for g in rotation.gamma):
            return rows
    raise ArithmeticError("a permanent rotation was not told from another in a thousand digits")


def secular(acting, n, b, item):
    """prod n_g^2 - sum B_g prod_(h != g) n_h^2."""
    total = item
    for axes in acting:
        total = total * n[axes[0]] * n[axes[0]]
    for axes in acting:
        term = sum((b[i] * b[i] for i in axes[1:]), b[axes[0]] * b[axes[0]]) * item
        for other in acting:
            if other is not axes:
                term = term * n[other[0]] * n[other[0]]
        total = total - term
    return total


def _free_part(axes, acting, S, b, item, arb):
    """Rotations with mu = S_g of a group without b."""
    gamma, rest = [arb(0)] * 3, item
    for other in acting:
        for i in other:
            value = -b[i] / (S[i] - S[axes[0]])
            gamma[i], rest = arb(value), rest - value * value
    if rest < 0:
        return
    size = arb(rest).sqrt()
    mu = arb(S[axes[0]])
    signs = (1,) if len(axes) > 1 else (1, -1) if rest else (1,)
    for sign in signs:
        gamma[axes[0]] = size * sign
        yield Rotation(mu, tuple(gamma), tuple(axes) if len(axes) > 1 and rest else ())


def rounded_gamma(rotation):
    return tuple(float(g.mid()) for g in rotation.gamma)


MINIMUM = Verdict("stable", Sentence(
    "field-minimum",
    "energy-Casimir: at constant area integral the energy has a strict minimum on |γ| = 1 (K positive "
    "definite), and it persists as the area changes")())
SADDLE = Verdict("unstable", Sentence(
    "field-saddle",
    "det K < 0: b < 0 in z⁴ + a z² + b, a positive eigenvalue")())
SPIRAL = Verdict("unstable", Sentence(
    "field-spiral",
    "a² < 4 b in z⁴ + a z² + b: four eigenvalues off the imaginary axis")())
REAL = Verdict("unstable", Sentence(
    "field-real",
    "a < 0 < b, a² > 4 b in z⁴ + a z² + b: two positive eigenvalues")())
NEGATIVE = Verdict("unstable", Sentence(
    "field-negative",
    "a < 0 in z⁴ + a z² + b: the squares of its roots sum to -2 a, so not all of them are imaginary")())
GYROSCOPIC = Verdict("undecided", Sentence(
    "field-gyroscopic",
    "K is negative definite and all eigenvalues are imaginary: the gyroscopic terms stabilise the linear "
    "motion, and the energy, a saddle here, does not decide for the full one")())
SLEEPING = Verdict("stable", Sentence(
    "sleeping-definite",
    "sleeping top: the spin about the axis of symmetry is a third integral; with distinct frequencies a "
    "combination of the three integrals is definite (Chetaev)")())
TURNS_BACK = Verdict("stable", Sentence(
    "sleeping-turns-back",
    "sleeping top: u'² = (1 - u)² G(u) by its three integrals, u the cosine of its lean; G < 0 for all u "
    "below and near 1, which bounds the lean of its neighbours too (Lagrange)")())
LEANS = Verdict("unstable", Sentence(
    "sleeping-leans",
    "sleeping top: u'² = (1 - u)² G(u) by its three integrals, u the cosine of its lean; G ≥ 0 for all u "
    "below and near 1, so motions from nearby lean further (Lagrange)")())
CIRCLE = Verdict("unstable", Sentence(
    "field-circle-drifts",
    "one of a circle of rotations about the axis of symmetry: with any small change of the spin about it γ "
    "drifts round the circle, so neighbours leave this point")())
OPEN = Verdict("undecided", Sentence(
    "field-coefficient-vanishes",
    "a coefficient of the spectrum vanishes here: the next order decides")())
SHELL = Verdict("undecided", Sentence(
    "field-continuum-open",
    "a continuum of rotations at one Ω, and a coefficient of the spectrum vanishes here: a term of higher "
    "order decides")())


def judged(field: Field, Omega: Fraction | arb, rotation) -> EquilibriumPoint:
    """Spectrum and verdict of a `Rotation` at Omega, exact or a ball; at = (omega, gamma)."""
    O = rational(Omega) if isinstance(Omega, Fraction) else Omega
    gamma, item = rotation.gamma, fmpq(1)
    a, b = coefficients(field, O, rotation.mu, gamma, item)
    determinant, trace = second_variation(field, O, rotation.mu, gamma, item)
    at = tuple(float(v.mid()) for v in (*(O * g for g in gamma), *gamma))
    if len(rotation.circle) == 2 and _symmetric(field, 3 - sum(rotation.circle)):
        return EquilibriumPoint(at, spectrum(a, 0 * b), "unstable" if a < 0 else "degenerate", CIRCLE.word,
                                reason=CIRCLE.reason)
    linear, verdict = _verdict(a, b, determinant, trace)
    if verdict in (GYROSCOPIC, OPEN) and (lean := _lean_of_sleeping(field, O, gamma)) is not None:
        verdict = LEANS if lean >= 0 else SLEEPING if verdict is GYROSCOPIC else TURNS_BACK
    if rotation.circle and verdict is OPEN:
        verdict = SHELL
    return EquilibriumPoint(at, spectrum(a, b), linear, verdict.word, reason=verdict.reason)


def _symmetric(field: Field, k: int) -> bool:
    """Whether axis k is an axis of symmetry of body, wheel, weight and charge."""
    i, j = (n for n in range(3) if n != k)
    return field.D[i] == field.D[j] and (k == 2 or field.E == 0) and not any(
        v != 0 for n in (i, j) for v in (field.s[n], field.Lambda[n]))


def _lean_of_sleeping(field: Field, Omega, gamma) -> int | None:
    """Sign of G(u) next to u = 1 for gamma along an axis of symmetry (for three equal moments: along the
    weight and the wheel), 0 where it vanishes at every u; None for any other gamma, and where balls leave it
    open.

    With sigma = +-1 along axis k, D_i = D_j = A, D_k = C, L = C Omega + sigma Lambda_k and w = 1 + u the
    energy, the area integral and omega_k give

        A^2 G = N (C - A) A w^2 - 2 A sigma s_k w - (L - E w/2)^2.
    """
    if field.E == 0 and field.D[0] == field.D[1] == field.D[2]:
        if any(v != 0 for v in cross(field.s, field.Lambda)):
            return None
        A = C = field.D[0]
        wheel, weight, E = dot(field.Lambda, gamma), dot(field.s, gamma), field.E
    else:
        k = next((k for k in range(3) if _symmetric(field, k)
                  and all(gamma[n] == 0 for n in range(3) if n != k)), None)
        if k is None:
            return None
        A, C, side = field.D[k - 1], field.D[k], 1 if gamma[k] > 0 else -1
        wheel, weight, E = side * field.Lambda[k], side * field.s[k], field.E if k == 2 else fmpq(0)
    L = C * Omega + wheel
    value = leaning(field, A, C, L, weight, E)
    slope = 4 * A * field.N * (C - A) - 2 * A * weight + E * (L - E)
    bend = 2 * A * field.N * (C - A) - E * E / 2
    for term in (value, -slope, bend):  # G at u = 1 - d is value - slope d + bend d^2/2, times A^2
        if arb(term) > 0 or arb(term) < 0:
            return 1 if arb(term) > 0 else -1
        if term != 0 or isinstance(term, arb) and not term.is_exact():
            return None
    return 0


def leaning(field: Field, A, C, L, weight, E):
    """A^2 G at u = 1: see `_lean_of_sleeping`; a sleeping top is unstable where it is positive."""
    return 4 * A * (field.N * (C - A) - weight) - (L - E) * (L - E)


def _verdict(a, b, determinant, trace):
    gap = a * a - 4 * b
    if b < 0:
        return "unstable", SADDLE
    if determinant > 0 and trace > 0:
        return ("stable" if gap > 0 else "degenerate"), MINIMUM
    if gap < 0:
        return "unstable", SPIRAL
    if a < 0:
        return "unstable", REAL if b > 0 and gap > 0 else NEGATIVE
    return ("stable", GYROSCOPIC) if b > 0 and gap > 0 else ("degenerate", OPEN)


def spectrum(a, b) -> tuple[complex, ...]:
    """0, 0 and the roots of z^4 + a z^2 + b (balls or exact numbers), opposite ones exactly opposite."""
    a, b = arb(a), arb(b)
    gap = a * a - 4 * b
    if gap < 0:
        ball = ((acb(-a) + acb(gap).sqrt()) / 2).sqrt()
        z = complex(float(ball.real.mid()), float(ball.imag.mid()))
        return (0j, 0j, z, -z, z.conjugate(), -z.conjugate())
    root = arb(max(float(gap.mid()), 0.0)).sqrt() if not gap > 0 else gap.sqrt()
    far = -(a + root) / 2 if a >= 0 else (root - a) / 2
    nearby = b / far if far != 0 else arb(0)
    return (0j, 0j, *_pair(far), *_pair(nearby))


def _pair(square):
    value = float(square.mid())
    z = complex(value**0.5, 0.0) if value > 0 else complex(0.0, (-value) ** 0.5)
    return z, -z


# of the distance to the next cut: where branches on the two sides of one are compared
NEXT_TO = Fraction(1, 2**90)
SHARED = Fraction(1, 2**200)


def cuts_of(field: Field) -> list[Fraction]:
    """Omega at which the number of rotations or the sign of a coefficient of the spectrum may change."""
    ring = fmpq_mpoly_ctx.get(("mu", "r", "O"), Ordering.lex)
    mu, r, O = ring.gens()
    item = ring.constant(1)
    S, b = [item * v for v in field.stiffness(O)], [item * v for v in field.pull(O)]
    parted = groups_at(S, b)
    acting = [axes for axes, idle in parted if not idle]
    critical = _of_sleeping(field, O)
    if acting:
        n = {i: S[i] - mu for axes in acting for i in axes}
        q, gamma = _homogeneous(acting, n, b, item)
        a, c = coefficients(field, O, mu, gamma, q)
        critical += changes(secular(acting, n, b, item), (c, a * a - 4 * c), (a,), "mu")
    for axes, idle in parted:
        if idle:
            n = {i: S[i] - S[axes[0]] for other in acting for i in other}
            q, gamma = _homogeneous(acting, n, b, item)
            square = q * q - sum((g * g for g in gamma), item * 0)
            gamma[axes[0]] = r
            a, c = coefficients(field, O, S[axes[0]], gamma, q)
            critical += [square, q, *changes(r * r - square, (c, a * a - 4 * c), (a,), "r")]
    return [root for f in critical for root in roots_in(f, 2)]


def changes(P, deciding, otherwise, name: str):
    """Polynomials without the variable `name`: one of them vanishes wherever the number of the real roots of
    P in it may change (but for zeros of P's leading coefficient), or a sign of `deciding` at one of them.

    Each irreducible factor of P is a branch of its own. Where a polynomial of `deciding` vanishes all along
    one and its sign decides nothing, those of `otherwise` join the others.
    """
    branches = [f for f, _ in P.factor()[1] if _degree(f, name) > 0]
    rows = [f.resultant(g, name) for f, g in combinations(branches, 2)]
    for branch in branches:
        if _degree(branch, name) > 1:
            rows.append(branch.discriminant(name))
        signs = [divmod(f, branch)[1] for f in deciding]
        if any(f == 0 for f in signs):
            signs += [divmod(f, branch)[1] for f in otherwise]
        rows += [branch.resultant(f, name) if _degree(f, name) > 0 else f for f in signs if f != 0]
    return rows


def _degree(f, name: str) -> int:
    """Its degree in one of its variables."""
    return f.degrees()[f.context().names().index(name)]


def _of_sleeping(field: Field, O):
    """Where a sleeping top gains or loses its stability: see `_lean_of_sleeping`."""
    return [leaning(field, field.D[k - 1], field.D[k], field.D[k] * O + side * field.Lambda[k],
                    side * field.s[k], field.E if k == 2 else fmpq(0))
            for k in range(3) if _symmetric(field, k) for side in (1, -1)]


def _homogeneous(acting, n, b, item):
    """(q, q gamma) with q = prod n_g."""
    q, gamma = item, [item * 0] * 3
    for axes in acting:
        q = q * n[axes[0]]
    for axes in acting:
        rest = -item
        for other in acting:
            if other is not axes:
                rest = rest * n[other[0]]
        for i in axes:
            gamma[i] = rest * b[i]
    return q, gamma


def roots_in(f, index: int) -> list[Fraction]:
    """Real roots of a polynomial in one of its variables alone as fractions, rational ones exact; none for a
    constant or zero."""
    polynomial = univariate(f, index)
    return real_roots(Poly.of(polynomial), MANY_BITS) if polynomial.degree() > 0 else []


def separated(cuts) -> list[Fraction]:
    """The cuts rising, each once: a root that two polynomials share comes out the same within 2**-200."""
    out: list[Any] = []
    for value in sorted(cuts):
        if not out or value - out[-1] > SHARED * max(abs(value), abs(out[-1])):
            out.append(value)
    return out


def step_at(cuts, cut: Fraction) -> Fraction:
    """How far beside a cut its branches are compared: far below the distance to the next one."""
    others = [abs(cut - other) for other in cuts if other != cut] or [abs(cut) or Fraction(1)]
    return min(others) * NEXT_TO
