"""Circles and spheres of permanent rotations at single rates Omega: where S is the same on axes that carry no b."""
from __future__ import annotations

from fractions import Fraction
from itertools import combinations
from math import cos, sin

from ...numbers.balls import rational
from ...numbers.exact import sqrt_fraction
from ...physics.coefficients import Content
from ..result import CurveSegment, EquilibriumCurve
from .balance import Rotation, rotations_at, rounded_gamma
from .bifurcations import NEXT_TO
from .spectrum import Field
from .verdict import judged


def circles(field: Field, parts: Content):
    """Every such circle or sphere as a curve of equilibria."""
    return tuple(_isolated(field, *item) for item in (*_special(field, parts), *_crossings(field, parts)))


def _special(field: Field, parts: Content):
    """(Omega, rotation) for rational Omega at which b vanishes on axes that share S, though not for every Omega."""
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
            rest = 1 - sum((g * g for g in gamma), arb(0))
            if rest > 0:
                gamma[axes[0]] = rest.sqrt()
                yield Omega, Rotation(arb(S[axes[0]]), tuple(gamma), tuple(axes))


def _exact(v) -> Fraction:
    return Fraction(int(v.p), int(v.q))


def _same_stiffness(parts: Content, i: int, j: int) -> list[Fraction]:
    """Real roots of (Omega^2 - N)(D_i - D_j) - Omega E (i is axis 3, less j is axis 3)."""
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
    axes, gamma, rate = rotation.circle, rounded_gamma(rotation), float(Omega)
    radius, names = gamma[axes[0]], ", ".join(f"gamma{i + 1}" for i in axes)

    def point(t: float):
        turned = list(gamma)
        turned[axes[0]], turned[axes[1]] = radius * cos(t), radius * sin(t)
        return (*(rate * g for g in turned), *turned)
    return (f"Omega = {rate:.12g}, ({names}) of length {radius:.12g}",
            f"t: angle in the plane of gamma{axes[0] + 1}, gamma{axes[1] + 1}", point)
