"""Cusps of fold curves: places where three equilibria meet, from the conditions for a triple root of R(x; p, q), exactly.

R has degree four at the most. F = 0 (a double root) with the first principal subresultant of R and R' zero (two double roots or a triple one) and the
discriminant of R' zero (not two double roots, whose R' has three different roots) is a triple root, and conversely. The p of such a place is a root of
a resultant, the q then a common root over the field of p.
"""
from __future__ import annotations

from collections.abc import Callable, Sequence
from fractions import Fraction
from functools import cache, partial
from typing import TYPE_CHECKING, Any, NamedTuple

from ...numbers.balls import Unclear, settled
from .critical import cuts
from .eliminated import Eliminated, evaluated, of_power, univariate
from .family import Family
from .field.algebraic import Algebraic, sharpened
from .verdicts import ball_form, doubles, state_of

if TYPE_CHECKING:
    from flint import arb, fmpq_mpoly


MOST_BITS = 2048  # beyond which a state is taken to have no number


class Cusp(NamedTuple):
    """A place where three equilibria meet. at: (p, q); state: in the case's variables, empty where a component is left open; polynomial, root: of p, as
    those of an event."""

    at: tuple[float, float]
    state: tuple[float, ...]
    polynomial: tuple[int, ...]
    root: int


def cusps(family: Family, eliminated: Eliminated, curves: Sequence[fmpq_mpoly]) -> list[Cusp]:
    """All of them in the range, on the curves F = 0 that hold double roots."""
    R = eliminated.reduced
    if R.degrees()[0] < 3:
        return []
    lead = of_power(R, 0, R.degrees()[0])
    conditions = _conditions(R)
    more = cache(lambda: [c for view in _others(eliminated) for c in _conditions(view)])
    found: dict[tuple[float, ...], Cusp] = {}
    for F in curves:
        others = [c for c in conditions if c.gcd(F).is_constant()]
        if others and F.degrees()[3] > 0 and lead.gcd(F).is_constant():
            for cusp in _on_curve(family, R, eliminated, F, others, lead, more):
                found.setdefault(tuple(round(v, 12) for v in cusp.at), cusp)
    return sorted(found.values())


def _conditions(R: fmpq_mpoly) -> tuple[fmpq_mpoly, fmpq_mpoly]:
    slope = R.derivative("x")
    return subresultant(R), slope.resultant(slope.derivative("x"), "x")


def _others(eliminated: Eliminated) -> list[fmpq_mpoly]:
    """R along one more direction: points that the main view has in line by chance are apart there."""
    return [eliminated.once(view.R) for view in eliminated.views[:2] if view is not eliminated.main and not view.R.is_zero()][:1]


def _on_curve(family: Family, R: fmpq_mpoly, eliminated: Eliminated, F: fmpq_mpoly, others: Sequence[fmpq_mpoly],
              lead: fmpq_mpoly, more: Callable[[], Sequence[fmpq_mpoly]]) -> list[Cusp]:
    shadows = [F.resultant(c, "q") for c in others]
    shadow = shadows[0]
    for other in shadows[1:]:
        shadow = shadow.gcd(other)
    if shadow.is_constant():
        return []
    first, second = family.spans
    out = []
    for cut in cuts((univariate(f, 2) for f, _ in shadow.factor()[1]), first.low, first.high):
        number = cut.number
        common = number.trimmed(_in_q(F))
        for c in others:
            common = number.gcd(common, number.trimmed(_in_q(c))) if common else []
        far = number.trimmed(_in_q(lead))  # where R loses its highest power nothing is known of its other roots
        common = number.divided(common, number.gcd(common, far))[0] if common and far else []
        common = _truly(number, common, eliminated, more)
        if len(common) > 1:
            places = settled(partial(_places, family, R, eliminated, number, common))
            out += [Cusp(at, state, tuple(int(c) for c in number.polynomial.numer().coeffs()), number.index) for at, state in places
                    if second.low <= Fraction(at[1]) <= second.high]
    return out


def _truly(number: Algebraic, common: Any, eliminated: Eliminated, more: Callable[[], Sequence[fmpq_mpoly]]) -> Any:
    """Of common roots q those where three points meet, and are not in line by chance: where that may be, another direction is asked."""
    apart = eliminated.apart
    if len(common) < 2:
        return common
    line = common if apart is None else number.gcd(common, f) if (f := number.trimmed(_in_q(apart))) else common
    if len(line) < 2:
        return common
    sure = number.divided(common, line)[0]
    for c in more():
        line = number.gcd(line, number.trimmed(_in_q(c))) if len(line) > 1 else line
    product = number.trimmed([sum((sure[i] * line[n - i] for i in range(len(sure)) if 0 <= n - i < len(line)), line[0] * 0)
                              for n in range(len(sure) + len(line) - 1)])
    return product


def _places(family: Family, R: fmpq_mpoly, eliminated: Eliminated, number: Algebraic, common, digits: Any):
    """[((p, q), state)] of the common roots q over the field of p, each with its triple root."""
    at, out = number.ball(digits.bits), []
    for q, _ in number.real_roots(number.powers(common), digits.bits):
        x = _triple_root(R, at, q)
        out.append(((float(at.mid()), float(q.mid())), _state(family, eliminated, x, at, q, digits.bits)))
    return out


def _state(family: Family, eliminated: Eliminated, x: arb, p: arb, q: arb, bits: int) -> tuple[float, ...]:
    """The state there; none where the other component has no number of its own (a whole line lies above x)."""
    try:
        y = eliminated.state(eliminated.main, x, [p, q])
        return doubles(state_of(family, y, ball_form(family, [p, q])[1]))
    except Unclear:
        if bits < MOST_BITS:
            raise
        return ()


def _triple_root(R: fmpq_mpoly, p: arb, q: arb) -> arb:
    """A simple root of the second derivative, or of the third where four roots meet, at which what stands before is zero within its balls."""
    from flint import acb_poly, arb, arb_poly
    zero = arb(0)
    rows = [arb_poly([evaluated(of_power(R, 0, n), [zero, zero, p, q]) for n in range(R.degrees()[0] + 1)])]
    while rows[-1].degree() > 1:
        rows.append(rows[-1].derivative())
    for n in range(2, len(rows)):
        try:
            roots = acb_poly(rows[n]).roots()
        except ValueError:
            continue
        real = [sharpened(list(rows[n].coeffs()), root.real) for root in roots if root.imag.contains(0)]
        fitting = [x for x in real if all(f(x).contains(0) for f in rows[:n])]
        if fitting:
            nearest = [(float(abs(arb_poly.evaluate(rows[1], [x])[0]).mid()), k) for k, x in enumerate(fitting)]
            return fitting[min(nearest)[1]]
    raise Unclear


def _in_q(F: fmpq_mpoly) -> list:
    """Coefficients of the powers of q, as polynomials in p."""
    return [univariate(of_power(F, 3, n), 2) for n in range(max(F.degrees()[3], 0) + 1)]


def subresultant(R: fmpq_mpoly) -> fmpq_mpoly:
    """The first principal subresultant coefficient of R and R' in x: zero where they share two roots, counted as often as they count."""
    f = [of_power(R, 0, n) for n in range(R.degrees()[0], -1, -1)]
    slope = R.derivative("x")
    g = [of_power(slope, 0, n) for n in range(R.degrees()[0] - 1, -1, -1)]
    n, m, zero = len(f) - 1, len(g) - 1, R * 0
    size = n + m - 2
    row = lambda c, shift: ([zero] * shift + list(c) + [zero] * size)[:size]
    return _determinant([*(row(f, k) for k in range(m - 1)), *(row(g, k) for k in range(n - 1))])


def _determinant(rows):
    if len(rows) == 1:
        return rows[0][0]
    total = rows[0][0] * 0
    for k, lead in enumerate(row[0] for row in rows):
        if not lead.is_zero():
            minor = _determinant([row[1:] for n, row in enumerate(rows) if n != k])
            total = total + lead * minor if k % 2 == 0 else total - lead * minor
    return total
