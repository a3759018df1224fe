"""Permanent rotations omega = Omega gamma of a body in a field (gravity, Newtonian, charge that follows the attitude; gyrostat).

gamma' = 0 makes omega parallel to gamma, and the rest is (S - mu) gamma = -b with the diagonal S(Omega) and b(Omega) of
`rotation_spectrum`: for each Omega the real roots mu of

    P(mu, Omega) = prod n_g^2 - sum B_g prod_(h != g) n_h^2,    n_g = S_g - mu,  B_g = sum of b_i^2 in g

over the groups g of equal S, gamma_i = -b_i/n_g; and, for a group whose b vanishes, mu = S_g with the part of gamma in it free up to
|gamma| = 1. The number of roots changes at zeros of the discriminant of P alone, and the signs that the verdicts rest on change at zeros of
resultants: polynomials in Omega with exact coefficients, all of whose real roots are isolated (python-flint). So the branches
are complete, and a verdict in the middle of an interval holds all over it.
"""
from __future__ import annotations

from contextlib import contextmanager
from dataclasses import dataclass
from fractions import Fraction
from itertools import combinations
from math import cos, sin

from ..errors import InputError
from .gyroscopic import Content
from .results import CurveSegment, Equilibria, EquilibriumCurve, EquilibriumPoint
from .rotation_spectrum import Field
from .rotation_verdict import judged
from .stability import _inside, sample_parameters

BITS = 256
NEXT_TO = Fraction(1, 2**90)   # of a cut: where branches on its two sides are compared
SAME = 2.0**-30                # far above the 2**-45 by which they differ there at most, far below their distance elsewhere
REASON = ("omega = Omega gamma, and (S - mu) gamma = -b with S = (Omega^2 - N) D - Omega E e3 e3^T, b = Omega Lambda + s: for each Omega one "
          "polynomial in mu; its discriminant and all its real roots are certified")


@dataclass(frozen=True)
class Rotation:
    """One solution at one Omega: mu and gamma as balls; circle: it stands for all its turns about axis 3 (or its own)."""

    mu: object
    gamma: tuple
    circle: tuple = ()


@contextmanager
def many_digits(bits: int = BITS):
    """flint works with `bits` bits inside."""
    from flint import ctx
    before, ctx.prec = ctx.prec, bits
    try:
        yield
    finally:
        ctx.prec = before


def permanent_rotations(parts: Content) -> Equilibria:
    """Every permanent rotation as curves over Omega (rad/s, any sign; a point is omega, gamma), with spectrum and verdicts."""
    with many_digits():
        field = Field.of(parts)
        cuts = _separated(_cuts(field))
        curves = tuple(_curve(field, number, branch, cuts) for number, branch in enumerate(_branches(field, cuts), 1))
        isolated = tuple(_isolated(field, *item) for item in (*_special(field, parts), *_crossings(field, parts)))
    return Equilibria("curves", REASON, curves=curves + isolated)


def rational(value: Fraction):
    """A Fraction as flint's rational."""
    from flint import fmpq
    return fmpq(value.numerator, value.denominator)


def groups_at(S, b):
    """[(axes of one value of S, whether b vanishes there)] for exact S, b."""
    values = list(dict.fromkeys(S)) if not hasattr(S[0], "to_dict") else _unique(S)
    return [(axes, not any(b[i] != 0 for i in axes)) for axes in ([i for i in range(3) if S[i] == v] for v in values)]


def _unique(values):
    out = []
    for v in values:
        if not any(v == w for w in out):
            out.append(v)
    return out


def rotations_at(field: Field, Omega: Fraction) -> list[Rotation]:
    """All permanent rotations with this Omega (exact), those of the polynomial first, rising in mu."""
    from flint import arb, fmpq, fmpq_poly
    O = rational(Omega)
    S, b = field.stiffness(O), field.pull(O)
    parted = groups_at(S, b)
    acting = [axes for axes, idle in parted if not idle]
    found = []
    if acting:
        mu = fmpq_poly([0, 1])
        n = {axes[0]: S[axes[0]] - mu for axes in acting}
        P = _secular(acting, n, b, fmpq_poly([1]))
        for root in sorted((r.real for r, _ in P.numer().complex_roots() if r.imag == 0), key=lambda r: r.mid()):
            gamma = [arb(0)] * 3
            for axes in acting:
                for i in axes:
                    gamma[i] = -b[i] / (S[i] - root)
            if all(g.is_finite() for g in gamma):  # a double root at S_g is none of the polynomial's own
                found.append(Rotation(root, tuple(gamma)))
    for axes, idle in parted:
        if idle:
            found += _free_part(axes, acting, S, b, fmpq(1), arb)
    return found


def _secular(acting, n, b, one):
    """prod n_g^2 - sum B_g prod_(h != g) n_h^2."""
    total = one
    for axes in acting:
        total = total * n[axes[0]] * n[axes[0]]
    for axes in acting:
        term = sum((b[i] * b[i] for i in axes[1:]), b[axes[0]] * b[axes[0]]) * one
        for other in acting:
            if other is not axes:
                term = term * n[other[0]] * n[other[0]]
        total = total - term
    return total


def _free_part(axes, acting, S, b, one, arb):
    """Rotations with mu = S_g of a group without b."""
    gamma, rest = [arb(0)] * 3, one
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


def _cuts(field: Field) -> list[Fraction]:
    """Omega at which the number of rotations or the sign of a coefficient of the spectrum may change."""
    from flint import Ordering, fmpq_mpoly_ctx
    from .rotation_spectrum import coefficients
    ring = fmpq_mpoly_ctx.get(("mu", "r", "O"), Ordering.lex)
    mu, r, O = ring.gens()
    one = ring.constant(1)
    S, b = [one * v for v in field.stiffness(O)], [one * v for v in field.pull(O)]
    parted = groups_at(S, b)
    acting = [axes for axes, idle in parted if not idle]
    critical = []
    if acting:
        n = {i: S[i] - mu for axes in acting for i in axes}
        q, gamma = _homogeneous(acting, n, b, one)
        P = _secular(acting, n, b, one)
        critical.append(P.discriminant("mu"))
        a, c = coefficients(field, O, mu, gamma, q)
        critical += [P.resultant(divmod(f, P)[1], "mu") for f in (c, a * a - 4 * c)]
    for axes, idle in parted:
        if idle:
            n = {i: S[i] - S[axes[0]] for other in acting for i in other}
            q, gamma = _homogeneous(acting, n, b, one)
            square = q * q - sum((g * g for g in gamma), one * 0)
            gamma[axes[0]] = r
            a, c = coefficients(field, O, S[axes[0]], gamma, q)
            critical += [square, q] + [_even(f, r, square) for f in (c, a * a - 4 * c)]
    return [root for f in critical for root in _real_roots(f)]


def _homogeneous(acting, n, b, one):
    """(q, q gamma) with q = prod n_g."""
    q, gamma = one, [one * 0] * 3
    for axes in acting:
        q = q * n[axes[0]]
    for axes in acting:
        rest = -one
        for other in acting:
            if other is not axes:
                rest = rest * n[other[0]]
        for i in axes:
            gamma[i] = rest * b[i]
    return q, gamma


def _even(f, r, square):
    """f with r^2 = square, times its mirror image in r: the same zeros, no r."""
    return f.resultant(r * r - square, "r") if "r" in _used(f) else f


def _used(f) -> set:
    return {name for name, degree in zip(("mu", "r", "O"), f.degrees()) if degree > 0}


def _real_roots(f):
    """Real roots of a polynomial in Omega alone as fractions, rational ones exact; none for a constant or zero."""
    from flint import fmpq_poly
    coefficients = {powers[2]: value for powers, value in f.to_dict().items()}
    if not coefficients or max(coefficients) == 0:
        return
    whole = fmpq_poly([coefficients.get(i, 0) for i in range(max(coefficients) + 1)])
    for factor, _ in whole.numer().factor()[1]:
        if factor.degree() == 1:  # exact
            yield Fraction(-int(factor[0]), int(factor[1]))
        else:
            yield from (_fraction(root.real) for root, _ in factor.complex_roots() if root.imag == 0)


def _fraction(ball) -> Fraction:
    man, exp = ball.mid().man_exp()
    return Fraction(int(man)) * Fraction(2) ** int(exp)


def _separated(cuts) -> list[Fraction]:
    """The cuts rising, each once."""
    values = sorted(cuts)
    size = max(map(abs, values), default=Fraction(1))
    out = []
    for value in values:
        if not out or value - out[-1] > size * NEXT_TO * 4:
            out.append(value)
    return out


def _float_gamma(rotation):
    return tuple(float(g.mid()) for g in rotation.gamma)


def _branches(field, cuts):
    """[[(lo, hi, index in rotations_at)]]: pieces between neighbouring cuts, joined across them by continuity of gamma."""
    ends = [None, *cuts, None]
    size = max(map(abs, cuts), default=Fraction(1)) or Fraction(1)
    open_, done = [], []
    for lo, hi in zip(ends, ends[1:]):
        found = rotations_at(field, _inside(lo, hi, size))
        joined = {}
        if lo is not None:
            step = size * NEXT_TO
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
    out = {}
    for _, i, j in sorted(pairs):
        if i not in out and j not in out.values():
            out[i] = j
    return out


def _sample(field, Omega: Fraction, index: int) -> EquilibriumPoint:
    return judged(field, Omega, rotations_at(field, Omega)[index])


def _curve(field, number, branch, cuts) -> EquilibriumCurve:
    """Segments of one verdict, changes of verdict and samples of one branch."""
    size = max(map(abs, cuts), default=Fraction(1)) or Fraction(1)
    pieces = [(lo, hi, index, _sample(field, _inside(lo, hi, size), index)) for lo, hi, index in branch]
    runs = []
    for piece in pieces:
        same = runs and _words(runs[-1][-1][3]) == _words(piece[3])
        runs[-1].append(piece) if same else runs.append([piece])
    segments, samples, changes = [], [], []
    for run in runs:
        lo, hi, middle = run[0][0], run[-1][1], run[len(run) // 2][3]
        where = (float("-inf") if lo is None else float(lo), float("inf") if hi is None else float(hi))
        segments.append(CurveSegment(where, middle.linear, middle.verdict, middle.because))
        samples += [_at(field, branch, t) for t in _chosen(lo, hi, size, cuts)]
        if run is not runs[-1]:
            changes.append(_at(field, branch, hi - size * NEXT_TO).at)
    circle = rotations_at(field, _inside(*branch[0][:2], size))[branch[0][2]].circle
    name = f"branch {number}" + (f", a circle about axis {6 - sum(i + 1 for i in circle)}" if circle else "")
    first, last = segments[0].t[0], segments[-1].t[1]
    return EquilibriumCurve(
        name, "omega = Omega gamma, ((Omega^2 - N) D gamma + Omega Lambda + s) x gamma = 0" + (" with the charge's term" if field.E != 0 else ""),
        f"t = Omega from {first:.6g} to {last:.6g} rad/s; gamma_i = -b_i/(S_i - mu)" + (", and all its turns in the circle" if circle else ""),
        _point_function(field, branch), tuple(segments), tuple(changes), tuple(samples))


def _words(sample):
    return sample.linear, sample.verdict, sample.because


def _chosen(lo, hi, size, cuts):
    """Three values of Omega of a segment, and 0 (rest) where it is inside; none on a cut."""
    some = [t for t in sample_parameters(lo, hi, size) if t not in cuts] or [_inside(lo, hi, size)]
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
        with many_digits():
            for lo, hi, index in branch:
                if (lo is None or lo < Omega) and (hi is None or Omega < hi):
                    gamma = _float_gamma(rotations_at(field, Omega)[index])
                    return (*(float(t) * g for g in gamma), *gamma)
        raise InputError(f"Omega = {t!r} lies at an end of this branch of permanent rotations or outside it")
    return point


def _special(field: Field, parts: Content):
    """(Omega, rotation) for rational Omega at which b vanishes on axes that share S, though not for every Omega."""
    from ..exact import sqrt_fraction
    values = {-s / l for s, l in zip(parts.s, parts.Lambda) if l}
    if parts.N >= 0:
        root = sqrt_fraction(parts.N)
        values |= {root, -root} if root * root == parts.N else set()
    for Omega in sorted(values):
        for rotation in rotations_at(field, Omega):
            if any(parts.s[i] or parts.Lambda[i] for i in rotation.circle):
                yield Omega, rotation


def _crossings(field: Field, parts: Content):
    """(Omega, rotation) where S is the same on groups of axes that never carry b: circles, or all directions."""
    from flint import arb
    idle = [axes for axes, never in _symbolic_groups(parts) if never]
    where = {Omega for first, second in combinations(idle, 2) for Omega in _same_stiffness(parts, first[0], second[0])}
    for Omega in sorted(where):  # rounded to 2**-240 where it is irrational, so S is compared within that
        S, b = field.stiffness(rational(Omega)), field.pull(rational(Omega))
        tiny = rational(max(map(_exact, S), key=abs) * NEXT_TO + NEXT_TO * max(parts.D) * (Omega * Omega + abs(parts.N)))
        for group in idle:
            axes = [i for i in range(3) if abs(S[i] - S[group[0]]) <= abs(tiny)]
            others = [i for i in range(3) if i not in axes]
            if axes[0] != group[0] or len(axes) == len(group) or any(parts.s[i] or parts.Lambda[i] for i in axes):
                continue
            gamma = [arb(-b[i] / (S[i] - S[axes[0]])) if i in others else arb(0) for i in range(3)]
            rest = 1 - sum(g * g for g in gamma)
            if rest > 0:
                gamma[axes[0]] = rest.sqrt()
                yield Omega, Rotation(arb(S[axes[0]]), tuple(gamma), tuple(axes))


def _exact(v) -> Fraction:
    return Fraction(int(v.p), int(v.q))


def _same_stiffness(parts: Content, i: int, j: int) -> list[Fraction]:
    """Real roots of (Omega^2 - N)(D_i - D_j) - Omega E (i is axis 3, less j is axis 3)."""
    from ..exact import sqrt_fraction
    A, B = parts.D[i] - parts.D[j], -parts.E * ((i == 2) - (j == 2))
    if not A:
        return [Fraction(0)]
    square = B * B + 4 * parts.N * A * A
    if square < 0:
        return []
    root = sqrt_fraction(square)
    return sorted({(-B - root) / (2 * A), (-B + root) / (2 * A)})


def _symbolic_groups(parts: Content):
    """Groups of axes that share S at every Omega, and whether b vanishes on them at every Omega."""
    key = [(d, parts.E if i == 2 else 0) for i, d in enumerate(parts.D)]
    for value in dict.fromkeys(key):
        axes = [i for i in range(3) if key[i] == value]
        yield axes, not any(parts.s[i] or parts.Lambda[i] for i in axes)


def _isolated(field, Omega: Fraction, rotation: Rotation) -> EquilibriumCurve:
    """A circle or sphere of permanent rotations at one Omega."""
    equation, parametrisation, point = around(Omega, rotation)
    sample = judged(field, Omega, rotation)
    segment = CurveSegment((float("-inf"), float("inf")), sample.linear, sample.verdict, sample.because)
    name = f"{'sphere' if len(rotation.circle) == 3 else 'circle'} at Omega = {float(Omega):.12g}"
    return EquilibriumCurve(name, equation, parametrisation, point, (segment,), (), (sample,))


def around(Omega: Fraction, rotation: Rotation):
    """(equation, parametrisation, point(t)) of the turns of a rotation within its circle; of a sphere one great circle."""
    axes, gamma, rate = rotation.circle, _float_gamma(rotation), float(Omega)
    radius, names = gamma[axes[0]], ", ".join(f"gamma{i + 1}" for i in axes)

    def point(t: float):
        turned = list(gamma)
        turned[axes[0]], turned[axes[1]] = radius * cos(t), radius * sin(t)
        return (*(rate * g for g in turned), *turned)
    return (f"Omega = {rate:.12g}, ({names}) of length {radius:.12g}",
            f"t: angle in the plane of gamma{axes[0] + 1}, gamma{axes[1] + 1}", point)
