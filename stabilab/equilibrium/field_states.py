"""Permanent rotations omega = Omega gamma of a body in a field (gravity, Newtonian, charge that follows the
attitude; gyrostat), and its steady states under a constant torque along a principal axis, as curves.

gamma' = 0 makes omega parallel to gamma, and the rest is (S - mu) gamma = -b with the diagonal S(Omega) and
b(Omega) of `field_balance`: for each Omega the real roots mu of

    P(mu, Omega) = prod n_g^2 - sum B_g prod_(h != g) n_h^2,    n_g = S_g - mu,  B_g = sum of b_i^2 in g

over the groups g of equal S, gamma_i = -b_i/n_g; and, for a group whose b vanishes, mu = S_g with the part of
gamma in it free up to |gamma| = 1. The number of roots changes at zeros of the discriminant of P alone, and
the signs that the verdicts rest on change at zeros of resultants: polynomials in Omega with exact
coefficients, all of whose real roots are isolated (python-flint). So the branches are complete, and a verdict
in the middle of an interval holds all over it. Where S is the same on axes that carry no b, there are circles
and spheres of rotations at single rates besides.

With a torque (S gamma + b) x gamma = -M asks for M . gamma = 0. With M along axis i, and neither wheel nor
weight along it, gamma = (0, cos t, sin t) on the axes (i, j, k) solves all but one equation, a quadratic in
Omega:

    A (Omega^2 - N) + B Omega + C = 0,   A = (D_j - D_k) cos t sin t,   C = s_j sin t - s_k cos t + M_i,
    B = Lambda_j sin t - Lambda_k cos t -+ E cos t sin t    (- where j is axis 3, + where k is)

So the steady states are two closed curves over t, real where the discriminant, a polynomial in tau =
tan(t/2), is not negative. Linear motion: z^2 (z^4 + e2 z^2 - e3 z + e4), for |gamma| is kept, the state lies
on a curve of others, and the flow keeps volume (no z^3 term). The four roots sum to zero, so any root off the
imaginary axis brings one with positive real part. The verdict changes along them
only at zeros in tau of resultants with e3, e4 and e2^2 - 4 e4 (e2 where one of these vanishes all along).
"""
from __future__ import annotations

from dataclasses import dataclass, replace
from fractions import Fraction
from itertools import combinations, pairwise
from math import atan, cos, inf, pi, sin, tan
from typing import Any

from flint import Ordering, arb, arb_mat, arb_poly, fmpq_mpoly_ctx

from ..errors import InputError
from ..numbers.balls import MANY_BITS, fraction, rational, working
from ..numbers.exact import sqrt_fraction
from ..numbers.polynomial import Poly, real_roots
from ..numbers.vectors import CYCLE, cross_matrix, nearest_first
from ..physics.coefficients import Content
from .field_balance import (
    NEXT_TO,
    Field,
    Rotation,
    blocks,
    changes,
    coefficients,
    cuts_of,
    judged,
    roots_in,
    rotations_at,
    rounded_gamma,
    separated,
    step_at,
)
from .result import (
    CurveSegment,
    Equilibria,
    EquilibriumCurve,
    EquilibriumPoint,
    float_ends,
    sample_parameters,
    values_inside,
)
from .stability import ordered


def circles(field: Field, parts: Content):
    """Every such circle or sphere as a curve of equilibria."""
    return tuple(_isolated(field, *item) for item in (*_special(field, parts), *_crossings(field, parts)))


def _special(field: Field, parts: Content):
    """(Omega, rotation) for rational Omega at which b vanishes on axes that share S, though not for every
    Omega."""
    values = {-s / l for s, l in zip(parts.s, parts.Lambda) if l}
    if parts.N >= 0:
        root = sqrt_fraction(parts.N)
        values |= {root, -root} if root * root == parts.N else set()
    for Omega in sorted(values):
        for rotation in rotations_at(field, Omega):
            if any(parts.s[i] or parts.Lambda[i] for i in rotation.circle):
                yield Omega, rotation


def _crossings(field: Field, parts: Content):
    """(Omega, rotation) where S is the same on groups of axes that never carry b: circles, or all directions.
    """
    idle = [axes for axes, never in _symbolic_groups(parts) if never]
    where = {Omega for first, second in combinations(idle, 2)
             for Omega in _same_stiffness(parts, first[0], second[0])}
    for Omega in sorted(where):  # rounded to 2**-240 where it is irrational, so S is compared within that
        S, b = field.stiffness(rational(Omega)), field.pull(rational(Omega))
        tiny = rational(max(map(fraction, S), key=abs) * NEXT_TO
                        + NEXT_TO * max(parts.D) * (Omega * Omega + abs(parts.N)))
        for group in idle:
            axes = [i for i in range(3) if abs(S[i] - S[group[0]]) <= abs(tiny)]
            others = [i for i in range(3) if i not in axes]
            other = any(parts.s[i] or parts.Lambda[i] for i in axes)
            if axes[0] != group[0] or len(axes) == len(group) or other:
                continue
            gamma = [arb(-b[i] / (S[i] - S[axes[0]])) if i in others else arb(0) for i in range(3)]
            rest = 1 - sum((g * g for g in gamma), arb(0))
            if rest > 0:
                gamma[axes[0]] = rest.sqrt()
                yield Omega, Rotation(arb(S[axes[0]]), tuple(gamma), tuple(axes))


def _same_stiffness(parts: Content, i: int, j: int) -> list[Fraction]:
    """Real roots of (Omega^2 - N)(D_i - D_j) - Omega E (i is axis 3, less j is axis 3)."""
    A, B = parts.D[i] - parts.D[j], -parts.E * ((i == 2) - (j == 2))
    return real_roots(Poly((-parts.N * A, B, A)), MANY_BITS) if A else [Fraction(0)]


def _symbolic_groups(parts: Content):
    """Groups of axes that share S at every Omega, and whether b vanishes on them at every Omega."""
    key = [(d, parts.E if i == 2 else 0) for i, d in enumerate(parts.D)]
    for value in dict.fromkeys(key):
        axes = [i for i in range(3) if key[i] == value]
        yield axes, not any(parts.s[i] or parts.Lambda[i] for i in axes)


def _isolated(field, Omega: Fraction, rotation: Rotation) -> EquilibriumCurve:
    """A circle or sphere of permanent rotations at one Omega, cut where the verdict may change."""
    equation, parametrisation, point = around(Omega, rotation)
    O, S0 = (v + arb(0, abs(float(v)) * float(NEXT_TO))  # Omega may be irrational, rounded
             for v in (arb(rational(Omega)), arb(rotation.mu).mid()))
    ends, segments, samples = _cuts_round(field, O, replace(rotation, mu=S0)), [], []
    for lo, hi in pairwise(ends):
        middle = GENERIC if lo == -inf else (lo + hi) / 2
        samples.append(judged(field, O, _turned(replace(rotation, mu=S0), middle)))
        segments.append(CurveSegment((lo, hi), *_words(samples[-1])))
    name = f"{'sphere' if len(rotation.circle) == 3 else 'circle'} at Omega = {float(Omega):.12g}"
    return EquilibriumCurve(name, equation, parametrisation, point, tuple(segments),
                            tuple(point(t) for t in ends[1:-1]), tuple(samples))


def _cuts_round(field, Omega: arb, rotation: Rotation) -> list[float]:
    """Angles of `around`, rising, between which a, b and a^2 - 4 b of the spectrum keep their signs: -inf and
    inf alone where they do all round."""
    i, j = rotation.circle[:2]
    radius, q = rotation.gamma[i], arb_poly([1, 0, 1])
    gamma = [q * g for g in rotation.gamma]
    gamma[i], gamma[j] = radius * arb_poly([1, 0, -1]), radius * arb_poly([0, 2])
    for axis in rotation.circle[2:]:
        gamma[axis] = arb_poly([])
    a, b = coefficients(field, Omega, rotation.mu, gamma, q)
    found = sorted(t for f in (a, b, a * a - 4 * b) for t in _zeros(f))
    apart = [t for n, t in enumerate(found) if not n or t - found[n - 1] > SAME]
    return [-pi, *apart, pi] if apart else [-inf, inf]


def _zeros(f: arb_poly) -> list[float]:
    """The angles 2 atan(tau) of the zeros of a polynomial in tau; none of one that is zero as far as balls
    tell."""
    import numpy as np
    while f.degree() >= 0 and f[f.degree()].contains(0):  # a degree that only rounding has
        f = arb_poly(f.coeffs()[:-1])
    found = np.roots([float(v.mid()) for v in reversed(f.coeffs())])  # pairs next to the line may be double
    return [2 * atan(z.real) for z in found.tolist() if abs(z.imag) <= NEAR * (1 + abs(z.real))]


def _turned(rotation: Rotation, t: float) -> Rotation:
    """Another of its circle, at the angle t of `around`."""
    i, j = rotation.circle[:2]
    gamma = list(rotation.gamma)
    gamma[i], gamma[j] = rotation.gamma[i] * arb(t).cos(), rotation.gamma[i] * arb(t).sin()
    return replace(rotation, gamma=tuple(gamma))


def around(Omega: Fraction, rotation: Rotation):
    """(equation, parametrisation, point(t)) of the turns of a rotation within its circle; of a sphere one
    great circle."""
    axes, gamma, rate = rotation.circle, rounded_gamma(rotation), float(Omega)
    radius, names = gamma[axes[0]], ", ".join(f"gamma{i + 1}" for i in axes)

    def point(t: float):
        turned = list(gamma)
        turned[axes[0]], turned[axes[1]] = radius * cos(t), radius * sin(t)
        return (*(rate * g for g in turned), *turned)
    return (f"Omega = {rate:.12g}, ({names}) of length {radius:.12g}",
            f"t: angle in the plane of gamma{axes[0] + 1}, gamma{axes[1] + 1}", point)


# far above the 2**-45 by which a branch differs on the two sides of a cut, far below the distance of two
# branches
SAME = 2.0**-30
NEAR = 1e-6    # of a zero of a polynomial: how far from the real line doubles may put a double one
GENERIC = 0.7  # rad: an angle on a circle that nothing singles out
REASON = ("omega = Omega gamma, and (S - mu) gamma = -b with S = (Omega^2 - N) D - Omega E e3 e3^T, b = "
          "Omega Lambda + s: for each Omega one "
          "polynomial in mu; its discriminant and all its real roots are certified")


def permanent_rotations(parts: Content) -> Equilibria:
    """Every permanent rotation as curves over Omega (rad/s, any sign; a point is omega, gamma), with spectrum
    and verdicts."""
    with working(MANY_BITS):
        field = Field.of(parts)
        cuts = separated(cuts_of(field))
        curves = tuple(_curve(field, number, branch, cuts)
                       for number, branch in enumerate(_branches(field, cuts), 1))
        curves += circles(field, parts)
    return Equilibria("curves", REASON, curves=curves)


def _branches(field, cuts):
    """[[(lo, hi, index in rotations_at)]]: pieces between neighbouring cuts, joined across them by continuity
    of gamma."""
    ends = [None, *cuts, None]
    size = max(map(abs, cuts), default=Fraction(1)) or Fraction(1)
    open_, done = [], []
    for lo, hi in zip(ends, ends[1:]):
        found = rotations_at(field, values_inside(lo, hi, size))
        joined = {}
        if lo is not None:
            step = step_at(cuts, lo)
            before, after = rotations_at(field, lo - step), rotations_at(field, lo + step)
            if len(after) != len(found):
                raise ArithmeticError("the branches of permanent rotations were not told apart")
            joined = _matching(before, after)
        fresh = [None] * len(found)
        for branch in open_:
            index = joined.get(branch[-1][2])
            if index is None:
                done.append(branch)
            else:
                fresh[index] = [*branch, (lo, hi, index)]
        open_ = [branch or [(lo, hi, index)] for index, branch in enumerate(fresh)]
    return done + open_


def _matching(before, after) -> dict[int, int]:
    """Index before -> index after for rotations at the same place, nearest first."""
    pairs = []
    for i, u in enumerate(before):
        for j, v in enumerate(after):
            apart = max(abs(float((x - y).mid())) for x, y in zip(u.gamma, v.gamma))
            if apart < SAME and bool(u.circle) == bool(v.circle):
                pairs.append((apart, i, j))
    return nearest_first(pairs)


def _sample(field, Omega: Fraction, index: int) -> EquilibriumPoint:
    return judged(field, Omega, rotations_at(field, Omega)[index])


def _curve(field, number, branch, cuts) -> EquilibriumCurve:
    """Segments of one verdict, changes of verdict and samples of one branch."""
    size = max(map(abs, cuts), default=Fraction(1)) or Fraction(1)
    pieces = [(lo, hi, index, _sample(field, values_inside(lo, hi, size), index)) for lo, hi, index in branch]
    runs: list[list[Any]] = []
    for piece in pieces:
        same = runs and _words(runs[-1][-1][3]) == _words(piece[3])
        runs[-1].append(piece) if same else runs.append([piece])
    segments, samples, changes = [], [], []
    for run in runs:
        lo, hi, middle = run[0][0], run[-1][1], run[len(run) // 2][3]
        segments.append(CurveSegment(float_ends(lo, hi), middle.linear, middle.verdict, middle.because))
        samples += [_at(field, branch, t) for t in _chosen(lo, hi, size, cuts)]
        if run is not runs[-1]:
            changes.append(_at(field, branch, hi - step_at(cuts, hi)).at)
    inside = values_inside(*branch[0][:2], size)  # type: ignore[call-arg]
    circle = rotations_at(field, inside)[branch[0][2]].circle
    name = f"branch {number}" + (f", a circle about axis {6 - sum(i + 1 for i in circle)}" if circle else "")
    first, last = segments[0].t[0], segments[-1].t[1]
    return EquilibriumCurve(
        name, "omega = Omega gamma, ((Omega^2 - N) D gamma + Omega Lambda + s) x gamma = 0"
        + (" with the charge's term" if field.E != 0 else ""),
        f"t = Omega from {first:.6g} to {last:.6g} rad/s; gamma_i = -b_i/(S_i - mu)"
        + (", and all its turns in the circle" if circle else ""),
        _point_function(field, branch), tuple(segments), tuple(changes), tuple(samples))


def _words(sample):
    return sample.linear, sample.verdict, sample.because


def _chosen(lo, hi, size, cuts):
    """Three values of Omega of a segment, and 0 (rest) where it is inside; none on a cut."""
    some = [t for t in sample_parameters(lo, hi, size) if t not in cuts] or [values_inside(lo, hi, size)]
    some = [some[0], some[len(some) // 2], some[-1]]
    if (lo is None or lo < 0) and (hi is None or hi > 0) and 0 not in cuts:
        some.append(Fraction(0))
    return sorted(set(some))


def _at(field, branch, Omega: Fraction) -> EquilibriumPoint:
    for lo, hi, index in branch:
        if (lo is None or lo <= Omega) and (hi is None or Omega <= hi):
            return _sample(field, Omega, index)
    raise InputError(f"Omega = {float(Omega)!r} lies outside this branch of permanent rotations")


def _point_function(field, branch):
    def point(t: float):
        Omega = Fraction(t)
        with working(MANY_BITS):
            for lo, hi, index in branch:
                if (lo is None or lo < Omega) and (hi is None or Omega < hi):
                    gamma = rounded_gamma(rotations_at(field, Omega)[index])
                    return (*(float(t) * g for g in gamma), *gamma)
        raise InputError(f"Omega = {t!r} lies at an end of this branch of permanent rotations or outside it")
    return point


COS, SIN, ONE = Poly((1, 0, -1)), Poly((0, 2)), Poly((1, 0, 1))  # times 1 + tau^2
OFF_AXIS = ("undecided: a constant torque off the principal axes, or one with a wheel or weight along it, "
            "holds a turning body only where "
            "three equations in Omega and gamma meet; no closed form is known")
SKEW = ("unstable",
        "e3 != 0 in z^4 + e2 z^2 - e3 z + e4: the four roots sum to zero and are not all imaginary, so one "
        "has positive real part")
PAIR = ("unstable",
        "e4 < 0, e2 < 0 or e2^2 < 4 e4 in z^4 + e2 z^2 - e3 z + e4: roots off the imaginary axis, whose sum "
        "is zero")
CENTRE = ("undecided",
          "all eigenvalues are imaginary, and with a torque that does work no integral is known that would "
          "decide the full motion")
OPEN = ("undecided", "a coefficient of the spectrum vanishes here: the next order decides")


@dataclass(frozen=True)
class Plane:
    """The quadratic in Omega for a torque along axis i, in tau = tan(t/2): coefficients times (1 + tau^2)^2.
    """

    i: int
    square: Poly
    linear: Poly
    constant: Poly

    @property
    def discriminant(self) -> Poly:
        return self.linear * self.linear - 4 * self.square * self.constant


def directed_equilibria(parts: Content) -> Equilibria:
    """Equilibria in a field or with a charge that follows the attitude: permanent rotations, and under a
    constant torque the steady states."""
    return steady_states(parts) if any(parts.M) else permanent_rotations(parts)


def steady_states(parts: Content) -> Equilibria:
    """All steady states of a body in a field with a constant torque, where they have a closed form."""
    acting = [i for i in range(3) if parts.M[i]]
    i = acting[0]
    if len(acting) > 1 or parts.s[i] or parts.Lambda[i]:
        return Equilibria("undecided", OFF_AXIS)
    plane = _plane(parts, i)
    cuts, sides = _changes(parts, plane), (-1, 1) if plane.square else (-1,)
    curves = tuple(_steady_curve(parts, plane, lo, hi, side, cuts) for lo, hi in _pieces(plane)
                   for side in sides)
    reason = (f"torque . gamma = 0 puts gamma across axis {i + 1}, and one quadratic in Omega remains; the "
              "intervals where it is real are those of a polynomial in tan(t/2) with exact coefficients")
    return (Equilibria("curves", reason, curves=curves) if curves
            else Equilibria("none", reason + ": there are none"))


def _plane(parts: Content, i: int) -> Plane:
    j, k = CYCLE[i]
    product, side = COS * SIN, (j == 2) - (k == 2)
    square = (parts.D[j] - parts.D[k]) * product
    linear = (parts.Lambda[j] * SIN - parts.Lambda[k] * COS) * ONE - parts.E * side * product
    constant = (parts.s[j] * SIN - parts.s[k] * COS) * ONE + parts.M[i] * ONE * ONE - parts.N * square
    return Plane(i, square, linear, constant)


def _pieces(plane: Plane):
    """Intervals of tau on which the quadratic has two real roots (one where D_j = D_k)."""
    cuts = {t for p in (plane.discriminant, plane.square, plane.linear if not plane.square else Poly(()))
            if p.degree > 0 for t in real_roots(p, MANY_BITS)}
    ends = [None, *separated({*cuts, Fraction(0)}), None]
    for lo, hi in zip(ends, ends[1:]):
        middle = values_inside(lo, hi, Fraction(1))
        if plane.discriminant(middle) > 0:
            yield lo, hi


def _omega(plane: Plane, tau: Fraction, side: int):
    """The root Omega at tau, where there is one, as a ball."""
    a, b, c = (rational(p(tau)) for p in (plane.square, plane.linear, plane.constant))
    if a == 0:
        return arb(-c / b)
    root = arb(b * b - 4 * a * c).sqrt()
    # the root without cancellation is near/a, the other c/near
    near = -(b + root) / 2 if b >= 0 else (root - b) / 2
    first, second = near / a, c / near if near != 0 else near / a
    low, high = (first, second) if first < second else (second, first)
    return low if side < 0 else high


def _state(plane: Plane, tau: Fraction, side: int):
    """(Omega, gamma) as balls."""
    j, k = CYCLE[plane.i]
    gamma = [arb(0)] * 3
    gamma[j], gamma[k] = (arb(rational(p(tau) / ONE(tau))) for p in (COS, SIN))
    return _omega(plane, tau, side), tuple(gamma)


def _point(parts: Content, plane: Plane, tau: Fraction, side: int) -> EquilibriumPoint:
    Omega, gamma = _state(plane, tau, side)
    _, _, e4, e3, e2, *_ = arb_mat(_jacobian(Field.of(parts), Omega, gamma)).charpoly().coeffs()
    e3 = -e3
    at = tuple(float(v.mid()) for v in (*(Omega * g for g in gamma), *gamma))
    return EquilibriumPoint(at, _eigenvalues(e2, e3, e4), *_verdict(e2, e3, e4))


def _jacobian(field: Field, Omega, gamma, q=1):
    """Rows of q times the derivative of the rates of (omega, gamma) at gamma/q."""
    A, B = blocks(field, Omega, gamma, q)
    return ([[*a, *b] for a, b in zip(A, B)]
            + [[*row, *(-Omega * v for v in row)] for row in cross_matrix(gamma)])


def _verdict(e2, e3, e4):
    if e3 != 0:  # a ball without 0
        return "unstable", *SKEW
    if e4 < 0 or e2 < 0 or e2 * e2 < 4 * e4:
        return "unstable", *PAIR
    if e4 > 0 and e2 > 0 and e2 * e2 > 4 * e4:
        return "stable", *CENTRE
    return "degenerate", *OPEN


def _eigenvalues(e2, e3, e4):
    import numpy as np
    roots = np.roots([1.0, 0.0, *(float(v.mid()) for v in (e2, -e3, e4))])
    return (0j, 0j, *ordered(roots))


def _changes(parts: Content, plane: Plane) -> list[Fraction]:
    """The tau at which the verdict on a root Omega of the quadratic may change: zeros of resultants of
    its irreducible factors with e3, e4, e2^2 - 4 e4, and with e2 where one of these vanishes all along."""
    O, tau = fmpq_mpoly_ctx.get(("O", "tau"), Ordering.lex).gens()
    of = lambda p: sum((rational(c) * tau**n for n, c in enumerate(p.c)), 0 * tau)
    (j, k), q, gamma = CYCLE[plane.i], of(ONE), [0 * tau] * 3
    gamma[j], gamma[k] = of(COS), of(SIN)
    J = _jacobian(Field.of(parts), O, gamma, q)
    J2 = [[sum((J[i][n] * J[n][m] for n in range(6)), 0 * tau) for m in range(6)] for i in range(6)]
    # traces of its powers; that of J itself is 0
    second, third, fourth = (sum((first[i][n] * rows[n][i] for i in range(6) for n in range(6)), 0 * tau)
                             for first, rows in ((J, J), (J2, J), (J2, J2)))
    e2, e3, e4 = -second / 2, third / 3, second * second / 8 - fourth / 4
    found = changes(of(plane.square) * O * O + of(plane.linear) * O + of(plane.constant),
                    (e4, e2 * e2 - 4 * e4, e3), (e2,), "O")
    return [root for f in found for root in roots_in(f, 1)]


def _steady_curve(parts, plane: Plane, lo, hi, side, cuts) -> EquilibriumCurve:
    """One side of the quadratic over one interval of tau, in segments of one verdict."""
    j, k = CYCLE[plane.i]
    fixed = [t for t in (lo, hi) if t is not None]
    inner = [t for t in separated([*cuts, *fixed]) if (lo is None or t > lo) and (hi is None or t < hi)
             and len(separated([t, *fixed])) > len(fixed)]
    segments, samples = [], []
    with working(MANY_BITS):
        for low, high in pairwise([lo, *inner, hi]):
            found = [_point(parts, plane, tau, side) for tau in _steady_samples(low, high)]
            words = _words(_point(parts, plane, values_inside(low, high, Fraction(1)), side))
            segments.append(CurveSegment((_angle(low, -1), _angle(high, 1)), *words))
            samples += found
        changed = tuple(_at_tau(plane, tau, side) for tau in inner)
    ends = _angle(lo, -1), _angle(hi, 1)

    def point(t: float):
        if not ends[0] < t < ends[1]:
            raise InputError(f"t = {t!r} lies at an end of this curve of steady states or outside it")
        with working(MANY_BITS):
            return _at_tau(plane, Fraction(tan(t / 2)), side)
    which = "lesser" if side < 0 else "greater"
    return EquilibriumCurve(
        f"{which} Omega for t in ({ends[0]:.6g}, {ends[1]:.6g})",
        f"gamma{plane.i + 1} = 0, A (Omega^2 - N) + B Omega + C = 0",
        f"gamma{j + 1} = cos t, gamma{k + 1} = sin t, omega = Omega gamma with the {which} root Omega", point,
        tuple(segments), changed, tuple(samples))


def _at_tau(plane: Plane, tau: Fraction, side: int):
    Omega, gamma = _state(plane, tau, side)
    return tuple(float(v.mid()) for v in (*(Omega * g for g in gamma), *gamma))


def _angle(tau, otherwise) -> float:
    from math import atan, pi
    return otherwise * pi if tau is None else 2 * atan(float(tau))


def _steady_samples(lo, hi):
    some = sample_parameters(lo, hi, Fraction(1)) or [values_inside(lo, hi, Fraction(1))]
    return sorted({some[0], some[len(some) // 2], some[-1]})
