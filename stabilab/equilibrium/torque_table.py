"""Which torque directions leave equilibria, and of what kind: the 27 sign patterns of (mu1, mu2, mu3).

Derived for the scaled system with X = x1 + a, Y = x1 + b = X + c, c = b - a, from its two linear balance
conditions mu1 X + mu2 x2 = 0 and mu1 Y - mu3 x3 = 0 and from the characteristic polynomial z^3 + m z + n,
m = X Y - x2^2 + x3^2, n = x2 x3 (X + Y). Corrects Table 1 of Amer et al. 2024 (whose major-axis entry X2 X3 =
-1 holds for a = b only, and whose stability conditions on the minor axis are not those of m > 0).
"""
from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import product
from typing import Any

from ..numbers.exact import exact
from ..numbers.vectors import Given

SIGN = {-1: "-", 0: "0", 1: "+"}
WELL = "stable: minimum of the reduced potential; unstable elsewhere, folds included"
UNSTABLE = "unstable: an eigenvalue with positive real part (n != 0)"
NO_X = "X = x1 + a = 0 forces x2 x3 = 0 when a = b, and x1' = mu1 does not vanish"
NO_Y = "Y = x1 + b = 0 forces x2 x3 = 0 when a = b, and x1' = mu1 does not vanish"
ONE_WITH_SECOND = dict(
    form="(-b, mu1 (b-a)/mu2, -mu2/(b-a))",
    polynomial="z^3 + m z + n, m = mu2^2/(b-a)^2 - mu1^2 (b-a)^2/mu2^2, n = mu1 (b-a)",
    spectrum="one real root of the sign of -mu1 (b-a); the real parts of the other two sum to its opposite")
ONE_WITH_THIRD = dict(
    form="(-a, -mu3/(b-a), mu1 (b-a)/mu3)",
    polynomial="z^3 + m z + n, m = mu1^2 (b-a)^2/mu3^2 - mu3^2/(b-a)^2, n = -mu1 (b-a)",
    spectrum="one real root of the sign of mu1 (b-a); the real parts of the other two sum to its opposite")
TWO_OF_EQUAL = dict(
    form="x1 = -a +- sqrt(mu2 mu3/mu1), x2 = -mu3/(x1 + a), x3 = mu2/(x1 + a)",
    polynomial="z^3 + m z + n, m = mu2 mu3/mu1 - x2^2 + x3^2, n = -+2 mu1 sqrt(mu2 mu3/mu1)")
TWO = dict(
    form="x1 = -(a+b)/2 +- (1/2) sqrt((b-a)^2 + 4 mu2 mu3/mu1), x2 = -mu3/(x1 + b), x3 = mu2/(x1 + a)",
    polynomial="z^3 + m z + n, m = mu2 mu3/mu1 - x2^2 + x3^2, n = -+2 mu1 (1/2) sqrt((b-a)^2 + 4 mu2 "
               "mu3/mu1)")


@dataclass(frozen=True)
class TorqueRow:
    """One sign pattern of the torque. kind as in Equilibria.kind (every kind that magnitudes allow); counts:
    the possible numbers of isolated equilibria (empty for curves); the rest is text in the symbols of the
    scaled system."""

    mu: tuple[str, ...]
    gyrostat: str
    kinds: tuple[str, ...]
    counts: tuple[int, ...]
    number: str
    form: str
    condition: str
    polynomial: str
    spectrum: str
    linear: str
    nonlinear: str


def torque_table(a: Given, b: Given) -> tuple[TorqueRow, ...]:
    """The 27 rows for one gyrostat: only whether a = b, and whether both vanish, matters. a, b: numbers or
    exact strings."""
    a, b = exact(a), exact(b)
    gyrostat = "a != b" if a != b else "a = b = 0" if not a else "a = b"
    order = sorted(product((1, 0, -1), repeat=3), key=lambda s: sum(map(abs, s)))
    return tuple(_row(signs, gyrostat) for signs in order)


def _row(signs: Sequence[int], gyrostat: str) -> TorqueRow:
    same = gyrostat != "a != b"
    acting = [i for i in range(3) if signs[i]]
    facts = (_no_torque, _one_torque, _two_torques, _three_torques)[len(acting)](signs, acting, same)
    if gyrostat == "a = b = 0":
        facts = {k: _without_shift(v) if isinstance(v, str) else v for k, v in facts.items()}
    return TorqueRow(tuple(SIGN[s] for s in signs), gyrostat, **facts)


def _without_shift(text: str) -> str:
    """The same formula with a = b = 0."""
    return text.replace("(x1 + a)", "x1").replace("x1 = -a", "x1 = 0").replace("(-a, ", "(0, ")


def _none(why: str) -> dict[str, Any]:
    return dict(kinds=("none",), counts=(0,), number="none", form="-", condition=why, polynomial="-",
                spectrum="-",
                linear="-", nonlinear="-")


def _curve(form: str, condition: str, m: str, linear: str, nonlinear: str,
           number: str = "a curve") -> dict[str, Any]:
    return dict(kinds=("curves",), counts=(), number=number, form=form, condition=condition,
                polynomial=f"z^3 + m z, m = {m}",
                spectrum="0, +-i sqrt(m) for m > 0; 0, +-sqrt(-m) for m < 0; 0, 0, 0 at folds",
                linear=linear, nonlinear=nonlinear)


def _no_torque(signs: Sequence[int], acting: Sequence[int], same: bool) -> dict[str, Any]:
    """x2 x3 = x3 X = x2 Y = 0: three lines; X and Y vanish together if a = b."""
    if same:
        return _curve("(x1, 0, 0), (-a, x2, 0), (-a, 0, x3)", "always", "(x1 + a)^2 - x2^2 + x3^2",
                      "centre on the lines along x1 and x3, unstable on the line along x2; degenerate where "
                      "they meet",
                      "stable along x1 and x3 and where the lines meet (energy-Casimir), unstable along x2",
                      "three lines")
    return _curve("(x1, 0, 0), (-b, x2, 0), (-a, 0, x3)", "always", "(x1 + a)(x1 + b) - x2^2 + x3^2",
                  "centre for (x1 + a)(x1 + b) > 0 on the line along x1 and for x3 != 0; unstable between -a "
                  "and -b and for x2 != 0; degenerate at (-a, 0, 0) and (-b, 0, 0)",
                  "stable at centres and at (-a, 0, 0) (energy-Casimir), unstable elsewhere and at "
                  "(-b, 0, 0)", "three lines")


def _one_torque(signs: Sequence[int], acting: Sequence[int], same: bool) -> dict[str, Any]:
    """The two linear conditions are one plane; one rate is left in it."""
    axis = acting[0]
    if axis == 0:
        if not same:
            return _none("mu1 (x1 + a) = 0 and mu1 (x1 + b) = 0 contradict each other")
        return _curve("x1 = -a, x2 x3 = -mu1", "always", "x3^2 - x2^2",
                      "centre iff |x3| > |x2|; folds |x2| = |x3| = sqrt|mu1|", WELL)
    if axis == 1:
        if same:
            return _curve("x2 = 0, x3 (x1 + a) = mu2", "always", "(x1 + a)^2 + x3^2",
                          "centre everywhere (m > 0)",
                          "stable: minimum of the reduced potential")
        return _curve("x2 = 0, x3 (x1 + a) = mu2", "always", "(x1 + a)(x1 + b) + x3^2",
                      "centre iff x3^4 + (b-a) mu2 x3 + mu2^2 > 0: everywhere if |b-a| < 4 3^(-3/4) "
                      "sqrt|mu2|, else outside two folds", WELL)
    if same:
        return _curve("x3 = 0, x2 (x1 + a) = -mu3", "always", "(x1 + a)^2 - x2^2",
                      "centre iff |x1 + a| > |x2|, that is |x2| < sqrt|mu3|; folds |x2| = |x1 + a| = "
                      "sqrt|mu3|", WELL)
    return _curve("x3 = 0, x2 (x1 + b) = -mu3", "always", "(x1 + a)(x1 + b) - x2^2",
                  "centre iff (x1 + a)(x1 + b) > x2^2, that is x2^4 < (b-a) mu3 x2 + mu3^2; one fold on each "
                  "branch", WELL)


def _two_torques(signs: Sequence[int], acting: Sequence[int], same: bool) -> dict[str, Any]:
    """One component is fixed by each condition; the rate across them gives the last, where c = b - a lets it.
    """
    if 0 not in acting:
        return _none("mu1 = 0 leaves mu2 x2 = 0 and mu3 x3 = 0, so x2 = x3 = 0, where x2' = mu2 and x3' = "
                     "mu3 do not vanish")
    with_third = acting[1] == 2
    if same:
        return _none(NO_X if with_third else NO_Y)
    return dict(kinds=("points",), counts=(1,), number="one", condition="a != b", linear="unstable (n != 0)",
                nonlinear=UNSTABLE) | (ONE_WITH_THIRD if with_third else ONE_WITH_SECOND)


def _three_torques(signs: Sequence[int], acting: Sequence[int], same: bool) -> dict[str, Any]:
    """X Y = p = mu2 mu3/mu1, so X^2 + c X - p = 0, x2 = -mu3/Y, x3 = mu2/X, n = -+mu1 sqrt(c^2 + 4 p)."""
    positive = signs[0] * signs[1] * signs[2] > 0
    if same and not positive:
        return _none("(x1 + a)^2 = mu2 mu3/mu1 is negative")
    facts = dict(
        kinds=("points",), counts=(2,), number="two", condition="always (mu2 mu3/mu1 > 0)",
        spectrum="one real root of the sign of -n; the real parts of the other two sum to its opposite",
        linear="unstable (n != 0)", nonlinear=UNSTABLE) | (TWO_OF_EQUAL if same else TWO)
    if positive:
        return facts
    return facts | dict(
        kinds=("none", "points"), counts=(0, 1, 2), number="two, one or none",
        condition="(b-a)^2 > 4 |mu2 mu3/mu1|: two; equal: one (fold, x1 = -(a+b)/2, n = 0); less: none",
        linear="unstable (n != 0); at the fold n = 0: unstable for m < 0, centre for m > 0, degenerate for m "
               "= 0, with m = 4 (mu2^2 - mu3^2)/(b-a)^2 - (b-a)^2/4",
        nonlinear="unstable: an eigenvalue with positive real part (n != 0); the fold too (m > 0: Chetaev "
                  "function for 0, +-i sqrt(m)), undecided there if m = 0")
