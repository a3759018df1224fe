"""The smallest change that makes a wrong formula right: single edits of its tree, tried one after another.

Edits: a sign, an index (another symbol of the same stem), another symbol of the formula, a missing or an
extra factor from the formula's own symbols and 2, sine for cosine, i for -i, a power raised, lowered, halved
or doubled, a term left out.
"""

from __future__ import annotations

import re
from itertools import islice

from ...errors import InputError
from ...theories.printed.claims import Paper, Row
from ...theories.printed.evaluate import Evaluator, Undefined, points, settled
from .checks import pairs as pairs_of
from .decide import decide, residual

MOST_EDITS = 900
KEEP = 3
TWINS = {
    "sin": ("cos", "tan", "sinh"),
    "cos": ("sin", "cosh"),
    "sinh": ("cosh", "tanh", "sin"),
    "cosh": ("sinh", "cos"),
    "tan": ("cot", "sin", "tanh"),
    "asin": ("acos",),
    "acos": ("asin",),
    "asinh": ("acosh", "atanh"),
    "atan": ("atanh",),
    "atanh": ("asinh", "atan"),
    "tanh": ("tan", "sinh"),
    "re": ("im",),
    "im": ("re",),
}


def repairs(paper: Paper, row: Row, printed, system, bound, domain, fixed=None) -> tuple[str, ...]:
    """Formulas "left = right", one edit away from the printed ones, that pass the row's check (under the
    condition `fixed`); at most KEEP."""
    found: list[str] = []
    try:
        trial = _Trial(paper, row, printed, system, bound, domain, fixed)
    except InputError:
        return ()
    for number, (left, right) in enumerate(printed):
        alone = row.kind in ("holds", "order")
        if alone and trial.agrees([(left, right)]):
            continue
        for edited in islice(_edits_of_sides(paper, row, left, right, fixed), MOST_EDITS):
            if edited not in printed and trial.agrees([edited] if alone
                                                      else [*printed[:number], edited,
                                                            *printed[number + 1 :]]):
                found.append(f"{edited[0]} = {edited[1]}")
            if len(found) == KEEP:
                return tuple(found)
    return tuple(found)


class _Trial:
    """Whether formulas pass a row's check: at two points in doubles, then with all digits."""

    def __init__(self, paper, row, printed, system, bound, domain, fixed):
        self.paper, self.row, self.system, self.bound, self.domain, self.fixed = (paper, row, system, bound,
                                                                                  domain, fixed)
        every = [s for name, s in paper.symbols.items() if name not in bound and name not in (fixed or {})]
        self.points = points(every, row.equation, 2, domain, bound, system, fixed)
        self.values = None  # an evaluator a point: an edit shares most of its parts with the one before

    def agrees(self, printed) -> bool:
        import mpmath

        try:
            if self.row.kind == "holds" and not self._near(printed):
                return False
            pairs = pairs_of(self.paper, self.row, printed, self.system, self.bound)
            if all(left == right for left, right in pairs):
                return False  # an edit that leaves nothing to be said
            found = [residual(pairs, mpmath.fp, point, self.bound, self.system, self.fixed)
                     for point in self.points]
        except (InputError, TypeError, AttributeError, KeyError):
            return False
        if any(r is None or r > 1e-7 for r in found):
            return False
        return (decide(pairs, self.bound, self.system, self.row.equation, self.domain, self.fixed,
                       symbolic=False).holds is True)

    def _near(self, printed):
        """Whether doubles leave it open that the formulas hold, without any work on symbols."""
        import mpmath

        if self.values is None:
            ready = [settled(mpmath.fp, point, self.fixed, self.bound, self.system) for point in self.points]
            self.values = [Evaluator(mpmath.fp, one, self.bound, self.system, in_numbers=True)
                           for one in ready]
        try:
            for value in self.values:
                for left, right in printed:
                    a, b = value(left), value(right)
                    if not abs(a - b) <= 1e-7 * max(1, abs(a), abs(b)):
                        return False
        except Undefined:
            return False
        return True


def _edits_of_sides(paper, row, left, right, fixed):
    import sympy as sp

    seen = {(left, right)}
    own = [s for s in sorted(left.free_symbols | right.free_symbols, key=lambda s: s.name)
           if s.name not in (fixed or {})]
    targets = [] if left.func.__name__ == "diff" else [(right, lambda e: (left, e))]
    if row.kind not in ("solves", "equilibrium") and (right.is_Number or left.has(sp.Function)):
        targets.append((left, lambda e: (e, right)))
    for factors in (False, True):  # the likelier edits first
        for tree, put in targets:
            for edited in edits(tree, own, paper.symbols, factors):
                pair = put(edited)
                if pair not in seen and pair[0] != pair[1]:
                    seen.add(pair)
                    yield pair


def edits(tree, own, declared, factors):
    """Every tree one edit away. own: symbols of the formula; declared: by name, for indices; factors: those
    with a factor more or less, else the others."""
    if not factors:
        yield -tree
    for place, node in _nodes(tree):
        for other in _with_factors(node, own,
                                   place == ()) if factors else _others(node, own, declared, place == ()):
            yield _replaced(tree, place, other)


def _nodes(tree, place=()):
    yield place, tree
    if tree.func.__name__ in ("rate", "diff", "mean", "at", "integral"):
        if not tree.args[0].is_Symbol:  # the rate of another variable would be another statement
            yield from _nodes(tree.args[0], (*place, 0))
        return
    for n, argument in enumerate(tree.args):
        yield from _nodes(argument, (*place, n))


def _replaced(tree, place, other):
    if not place:
        return other
    n, *rest = place
    return tree.func(*(_replaced(a, tuple(rest), other) if i == n else a for i, a in enumerate(tree.args)))


def _others(node, own, declared, top):
    """Signs, indices, other symbols, powers, twins of functions, terms and factors left out."""
    import sympy as sp

    if node.is_Symbol:
        yield from _siblings(node, declared)
        yield from (s for s in own if s != node)
    if node.is_Pow or node.is_Symbol:
        base, power = node.as_base_exp()
        if power.is_Number:
            yield from (base**p for p in (power + 1, power - 1, power * 2, power / 2, -power))
    yield from (getattr(sp, twin)(*node.args) for twin in TWINS.get(node.func.__name__, ()))
    if node == sp.I:
        yield -sp.I
    if node.is_Rational and not top:
        yield from (-node, node * 2, node / 2, node + 1)
    for n, part in enumerate(node.args if node.is_Add or node.is_Mul else ()):
        rest = node.args[:n] + node.args[n + 1 :]
        yield node.func(*rest)
        if node.is_Add:
            yield sp.Add(*rest, -part)


def _with_factors(node, own, top):
    """A factor more, or one less, of a term."""
    import sympy as sp

    factors = (*own, sp.Integer(2), sp.I)
    if node.is_Add:
        for n, term in enumerate(node.args):
            rest = node.args[:n] + node.args[n + 1 :]
            yield from (sp.Add(*rest, changed) for factor in factors
                        for changed in (term * factor, term / factor))
    if top or node.is_Mul:
        yield from (changed for factor in factors for changed in (node * factor, node / factor))


def _siblings(symbol, declared):
    """Declared symbols of the same stem: D2, D3 for D1."""
    stem = re.sub(r"\d+$", "", symbol.name)
    return [s for name, s in declared.items() if s != symbol and name != stem
            and re.sub(r"\d+$", "", name) == stem]
