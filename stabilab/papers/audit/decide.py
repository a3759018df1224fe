"""Whether two expressions are one: by symbols where SymPy can, else by their values at random points with 50
and 80 digits."""

from __future__ import annotations

from dataclasses import dataclass

from ...errors import InputError
from ...theories.printed.evaluate import Evaluator, Undefined, points, precise, settled

DIGITS = (50, 80)  # a claim "holds" by values only if its residual shrinks with the digits
POINTS = 5
SLACK = 14  # digits that cancellation may cost at points of order one
APART = 1e-6  # relative difference at a point that settles it
SYMBOLIC_SIZE = 250  # operations up to which symbols are tried


@dataclass(frozen=True)
class Decision:
    """holds: True, False, or None where it could not be told; residual: largest relative difference seen;
    method: words."""

    holds: bool | None
    residual: float
    method: str


def decide(pairs, bound: dict, system, seed: str, domain=(), fixed=None, symbolic=True) -> Decision:
    """Whether left equals right in every pair, for all values of the free symbols at which `domain` is
    positive. fixed: name -> expression (a condition)."""

    chosen, none = (), ""
    try:
        chosen = points(free(pairs, domain, bound, system, fixed), seed, POINTS, domain, bound, system, fixed)
    except InputError as error:
        none = str(error)
    if symbolic and not fixed and all(_same_in_symbols(left, right, bound, system, chosen[:1]) for left,
                                      right in pairs):
        return Decision(True, 0.0, "symbols")
    if none:
        return Decision(None, float("nan"), none)
    worst, seen = {}, 0
    for digits in DIGITS:
        numbers = precise(digits)
        found = [residual(pairs, numbers, point, bound, system, fixed) for point in chosen]
        found = [r for r in found if r is not None]
        seen, worst[digits] = len(found), max(found, default=None)
        if found and worst[digits] > 10.0 ** -(DIGITS[0] - SLACK):
            return Decision(False, float(worst[digits]), f"residual at random points, {digits} digits")
    if not seen:
        return Decision(None, float("nan"), "the formula has no value at any of the random points")
    if worst[DIGITS[1]] > 10.0 ** -(DIGITS[1] - SLACK):
        return Decision(None, float(worst[DIGITS[1]]), "the residual does not shrink with the digits")
    return Decision(True, float(worst[DIGITS[1]]),
                    f"residuals at {seen} random points, {DIGITS[0]} and {DIGITS[1]} digits")


def residual(pairs, numbers, point, bound, system, fixed=None):
    """Largest relative difference at one point; None where the formula has no value there."""
    ready = settled(numbers, point, fixed, bound, system)
    if ready is None:
        return None
    value, worst = Evaluator(numbers, ready, bound, system), numbers.mpf(0)
    try:
        for left, right in pairs:
            a, b = value(left), value(right)
            size = max(abs(a), abs(b), _largest_term(value, left), _largest_term(value, right))
            if size:
                worst = max(worst, abs(a - b) / size)
    except Undefined:
        return None
    return worst


def _largest_term(value, expression):
    """Size of the largest term of a sum: what a difference of rounding is to be compared with."""
    return max((abs(value(term)) for term in expression.args), default=0) if expression.is_Add else 0


def free(pairs, domain, bound, system, fixed=None):
    """Symbols that need a value, in order of their names."""
    found, waiting, done = set(), [e for pair in pairs for e in pair] + list(domain), set()
    if system is not None and any(e.has(*_rates()) for e in waiting):
        waiting += list(system.rates)
    while waiting:
        for s in waiting.pop().free_symbols:
            if s.name in bound:
                if s.name not in done:
                    done.add(s.name)
                    waiting.append(bound[s.name])
            elif fixed and s.name in fixed:
                if s.name not in done:
                    done.add(s.name)
                    waiting.append(fixed[s.name])
            else:
                found.add(s)
    return sorted(found, key=lambda s: s.name)


def _rates():
    import sympy as sp

    return (sp.Function("rate"),)


def _apart(left, right, bound, system, chosen):
    """Whether two expressions differ by so much at a point that no rounding of 50 digits makes up for it."""
    found = [residual([(left, right)], precise(DIGITS[0]), point, bound, system) for point in chosen]
    return any(r is not None and r > APART for r in found)


def _same_in_symbols(left, right, bound, system, chosen=()):
    """Whether symbols show it; chosen: points at which expressions that differ plainly are told apart before
    their terms are multiplied out."""
    import sympy as sp

    plain = Evaluator(None, {}, bound, system).plain
    try:
        difference = plain(left) - plain(right)
    except InputError:
        return False
    if difference == 0:
        return True
    if difference.has(sp.Function("mean"), sp.Function("integral"), sp.Function("diff"),
                      sp.Function("at")) or sp.count_ops(difference) > SYMBOLIC_SIZE:
        return False
    try:
        if _apart(left, right, bound, system, chosen):
            return False
        if sp.expand(difference) == 0:
            return True
        numerator = sp.numer(sp.together(difference))
        return sp.expand(numerator) == 0 or sp.expand(sp.expand_trig(sp.expand(numerator))) == 0
    except (RecursionError, sp.PolynomialError):
        return False
