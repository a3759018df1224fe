"""Permanent rotations omega = Omega gamma of a body in a field (gravity, Newtonian, charge that follows the
attitude; gyrostat), as curves.

gamma' = 0 makes omega parallel to gamma, and the rest is (S - mu) gamma = -b with the diagonal S(Omega) and
b(Omega) of `field_balance`: for each Omega the real roots mu of

    P(mu, Omega) = prod n_g^2 - sum B_g prod_(h != g) n_h^2,    n_g = S_g - mu,  B_g = sum of b_i^2 in g

over the groups g of equal S, gamma_i = -b_i/n_g; and, for a group whose b vanishes, mu = S_g with the part of
gamma in it free up to |gamma| = 1. The number of roots changes at zeros of the discriminant of P alone, and
the signs that the verdicts rest on change at zeros of resultants: polynomials in Omega with exact
coefficients, all of whose real roots are isolated (python-flint). So the branches are complete, and a verdict
in the middle of an interval holds all over it. Where S is the same on axes that carry no b, there are circles
and spheres of rotations at single rates besides.

`steady_states` has those under a torque.
"""
from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from itertools import combinations, pairwise
from math import atan, cos, inf, pi, sin
from typing import Any

from flint import arb, arb_poly

from ..errors import InputError
from ..numbers.balls import MANY_BITS, fraction, rational, working
from ..numbers.exact import sqrt_fraction
from ..numbers.polynomial import Poly, real_roots
from ..numbers.vectors import nearest_first
from ..physics.coefficients import Content
from ..reasons import Axis, Coefficient, Formula, Reason, Sentence, Unit
from .description import ANGLE, OVER_RATE, RATE, Description
from .field_balance import (
    NEXT_TO,
    Field,
    Rotation,
    coefficients,
    cuts_of,
    judged,
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
from .steady_states import steady_states


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
    equation, run, point = around(Omega, rotation)
    O, S0 = (v + arb(0, abs(float(v)) * float(NEXT_TO))  # Omega may be irrational, rounded
             for v in (arb(rational(Omega)), arb(rotation.mu).mid()))
    ends, segments, samples = _cuts_round(field, O, replace(rotation, mu=S0)), [], []
    for lo, hi in pairwise(ends):
        middle = GENERIC if lo == -inf else (lo + hi) / 2
        samples.append(judged(field, O, _turned(replace(rotation, mu=S0), middle)))
        segments.append(CurveSegment.like(samples[-1], (lo, hi)))
    name = SPHERE_AT if len(rotation.circle) == 3 else CIRCLE_AT
    about = Description(name(rate=Coefficient(float(Omega), RATE, 12)), equation, run, unit=ANGLE)
    return EquilibriumCurve(about, point, tuple(segments), tuple(point(t) for t in ends[1:-1]),
                            tuple(samples))


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
    result = sorted(t for f in (a, b, a * a - 4 * b) for t in _zeros(f))
    apart = [t for n, t in enumerate(result) if not n or t - result[n - 1] > SAME]
    return [-pi, *apart, pi] if apart else [-inf, inf]


def _zeros(f: arb_poly) -> list[float]:
    """The angles 2 atan(tau) of the zeros of a polynomial in tau; none of one that is zero as far as balls
    tell."""
    import numpy as np
    while f.degree() >= 0 and f[f.degree()].contains(0):  # a degree that only rounding has
        f = arb_poly(f.coeffs()[:-1])
    result = np.roots([float(v.mid()) for v in reversed(f.coeffs())])  # pairs next to the line may be double
    return [2 * atan(z.real) for z in result.tolist() if abs(z.imag) <= ROOT_TOLERANCE * (1 + abs(z.real))]


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
    radius, names = gamma[axes[0]], [f"γ{i + 1}" for i in axes]

    def point(t: float):
        turned = list(gamma)
        turned[axes[0]], turned[axes[1]] = radius * cos(t), radius * sin(t)
        return (*(rate * g for g in turned), *turned)
    return (AROUND(rate=Coefficient(rate, RATE, 12), components=Formula((", ".join(names),)),
                   length=Coefficient(radius, digits=12)),
            ANGLE_IN_PLANE(first=Formula((names[0],)), second=Formula((names[1],))), point)


# far above the 2**-45 by which a branch differs on the two sides of a cut, far below the distance of two
# branches
SAME = 2.0**-30
ROOT_TOLERANCE = 1e-6    # of a zero of a polynomial: how far from the real line doubles may put a double one
SPHERE_AT = Sentence("sphere-at-rate", "sphere at Ω = {rate}")
CIRCLE_AT = Sentence("circle-at-rate", "circle at Ω = {rate}")
AROUND = Sentence("turns-at-rate", "Ω = {rate}, ({components}) of length {length}")
ANGLE_IN_PLANE = Sentence("angle-in-plane", "t: angle in the plane of {first}, {second}")
BRANCH = Sentence("branch-number", "branch {number}")
A_CIRCLE = Sentence("a-circle-about", "a circle about {axis}")
BALANCE = Sentence("balance-of-rotation", "ω = Ω γ, ((Ω² - N) D γ + Ω Λ + s) x γ = 0")()
WITH_CHARGE = Sentence("with-charge-term", "with the charge's term")()
GAMMA_OF_RATE = Sentence("gamma-of-rate", "γᵢ = (Ω Λᵢ + sᵢ)/(μ - (Ω² - N) Dᵢ), μ by |γ| = 1")()
GAMMA_WITH_CHARGE = Sentence(
    "gamma-of-rate-charged",
    "γᵢ = (Ω Λᵢ + sᵢ)/(μ - (Ω² - N) Dᵢ), for i = 3 with + Ω E below the line, μ by |γ| = 1")()
ALL_TURNS = Sentence("all-turns-in-circle", "and all its turns in the circle")()
GENERIC = 0.7  # rad: an angle on a circle that nothing singles out
REASON = Sentence(
    "permanent-rotations-complete",
    "ω = Ω γ, and (S - μ) γ = -b with S = (Ω² - N) D - Ω E e3 e3^T, b = Ω Λ + s: for each Ω one polynomial "
    "in μ; its discriminant and all its real roots are certified")()


def permanent_rotations(parts: Content) -> Equilibria:
    """Every permanent rotation as curves over Omega (rad/s, any sign; a point is omega, gamma), with spectrum
    and verdicts."""
    with working(MANY_BITS):
        field = Field.of(parts)
        cuts = separated(cuts_of(field))
        curves = tuple(_curve(field, number, branch, cuts)
                       for number, branch in enumerate(_branches(field, cuts), 1))
        curves += circles(field, parts)
    return Equilibria("curves", curves=curves, reason=REASON)


def _branches(field, cuts):
    """[[(lo, hi, index in rotations_at)]]: pieces between neighbouring cuts, joined across them by continuity
    of gamma."""
    ends = [None, *cuts, None]
    size = max(map(abs, cuts), default=Fraction(1)) or Fraction(1)
    open_, done = [], []
    for lo, hi in zip(ends, ends[1:]):
        result = rotations_at(field, values_inside(lo, hi, size))
        joined = {}
        if lo is not None:
            step = step_at(cuts, lo)
            before, after = rotations_at(field, lo - step), rotations_at(field, lo + step)
            if len(after) != len(result):
                raise ArithmeticError("the branches of permanent rotations were not told apart")
            joined = _matching(before, after)
        fresh = [None] * len(result)
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
        same = runs and _judgement(runs[-1][-1][3]) == _judgement(piece[3])
        runs[-1].append(piece) if same else runs.append([piece])
    segments, samples, changes = [], [], []
    for run in runs:
        lo, hi, middle = run[0][0], run[-1][1], run[len(run) // 2][3]
        segments.append(CurveSegment.like(middle, float_ends(lo, hi)))
        samples += [_at(field, branch, t) for t in _chosen(lo, hi, size, cuts)]
        if run is not runs[-1]:
            changes.append(_at(field, branch, hi - step_at(cuts, hi)).at)
    inside = values_inside(*branch[0][:2], size)  # type: ignore[call-arg]
    circle = rotations_at(field, inside)[branch[0][2]].circle
    name = BRANCH(number=number).then(
        A_CIRCLE(axis=Axis(6 - sum(i + 1 for i in circle))) if circle else None, ", ")
    first, last = (Coefficient(end, RATE, 6) for end in (segments[0].t[0], segments[-1].t[1]))
    parametrisation = OVER_RATE(low=first, high=last, unit=Unit(RATE)).then(
        GAMMA_WITH_CHARGE if field.E != 0 else GAMMA_OF_RATE)
    about = Description(name, BALANCE.then(WITH_CHARGE if field.E != 0 else None, " "),
                        parametrisation.then(ALL_TURNS if circle else None, ", "), "Ω")
    return EquilibriumCurve(about, _point_function(field, branch), tuple(segments), tuple(changes),
                            tuple(samples))


def _judgement(sample: EquilibriumPoint) -> tuple[str, str, Reason]:
    return sample.linear, sample.verdict, sample.reason


FARTHEST = 10  # times its finite end, or the largest cut: how far samples go on a branch without an end


def _chosen(lo, hi, size, cuts):
    """Three values of Omega of a segment, and 0 (rest) where it is inside; none on a cut."""
    largest = FARTHEST * max(size, *(abs(end) for end in (lo, hi) if end is not None), Fraction(0))
    ends = -largest if lo is None else lo, largest if hi is None else hi
    some = [t for t in sample_parameters(*ends, size) if t not in cuts] or [values_inside(lo, hi, size)]
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


def directed_equilibria(parts: Content) -> Equilibria:
    """Equilibria in a field or with a charge that follows the attitude: permanent rotations, and under a
    constant torque the steady states."""
    return steady_states(parts) if any(parts.M) else permanent_rotations(parts)
