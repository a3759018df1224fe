"""The verdicts on the formulas of a paper, their units included.

A row is compared with the equations of motion; its verdict has the condition, the correction, how it was
decided, and the smallest change that makes a wrong formula right: single edits of its tree, tried one after
another.

Edits: a sign, an index (another symbol of the same stem), another symbol of the formula, a missing or an
extra factor from the formula's own symbols and 2, sine for cosine, i for -i, a power raised, lowered, halved
or doubled, a term left out."""
from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from itertools import islice
from typing import TYPE_CHECKING, Any

from ...errors import InputError
from ...numbers.units import unit_of
from ...theories.printed.claims import Paper, Row, parse
from ...theories.printed.evaluate import Setting, Undefined
from . import checks
from .checks import bound_of, raw
from .numbers import filled

if TYPE_CHECKING:
    from sympy import Expr


# --- Whether the printed formulas of a row add like to like
def unit_fault(paper: Paper, row: Row) -> str:
    """Which terms of the printed formulas differ in unit; "" where none do."""
    import sympy as sp
    if row.options.get("units") is False or row.kind not in ("holds", "solves", "equilibrium", "order"):
        return ""
    data = paper.systems.get(row.system or "", {})
    time = dimension(_time_of(paper, data))
    units = {name: dimension(unit) for name, unit in paper.units.items()}
    bound = bound_of(paper, row)
    try:
        for name in [n for n in bound if n not in units]:
            units[name] = formula_unit(bound[name], units, time) or NONE
        for left, right in raw(paper, row.printed):
            formula_unit(sp.Add(left, -right, evaluate=False), units, time)
    except UnitFault as fault:
        return str(fault)
    return ""


def _time_of(paper: Paper, data: Mapping[str, Any]):
    while "time" not in data and "follows" in data and "rates" not in data:
        data = paper.systems[data["follows"]]
    return data.get("time", "s")


# --- Whether the terms of a formula have one unit: dimensions carried through a SymPy tree, exponents of m,
# kg, s, A
BASE = ("m", "kg", "s", "A")
NONE: tuple = (0,) * len(BASE)


class UnitFault(Exception):
    """Two terms of a sum that differ in dimension, or a function of something with one."""


def dimension(text: str) -> tuple:
    """Of "kg m^2 s^-1" or "N m/s", an angle being a number. InputError for unknown units."""
    return unit_of(text).dimension[:len(BASE)]


def times(first: tuple, second: tuple, power: int | Fraction = 1) -> tuple:
    return tuple(a + b * power for a, b in zip(first, second))


def told(unit: tuple) -> str:
    return " ".join(name if power == 1 else f"{name}^{power}" for name, power in sorted(zip(BASE, unit))
                    if power) or "no unit"


def formula_unit(expression: Expr, units: dict, time: tuple):
    """Dimension of a raw formula; units: symbol name -> dimension; time: dimension of the motion's time. None
    for a zero. Raises UnitFault."""
    import sympy as sp

    def visit(e):
        if e.is_Number:
            return None if e == 0 else NONE
        if e.is_Symbol:
            return units.get(e.name, NONE)
        if e.is_Add:
            rows = [(term, visit(term)) for term in e.args]
            rows = [(term, unit) for term, unit in rows if unit is not None]
            for term, unit in rows[1:]:
                if unit != rows[0][1]:
                    raise UnitFault(f"{rows[0][0]} [{told(rows[0][1])}] is added to {term} [{told(unit)}]")
            return rows[0][1] if rows else None
        if e.is_Mul:
            out = NONE
            for factor in e.args:
                unit = visit(factor)
                if unit is None:
                    return None
                out = times(out, unit)
            return out
        if e.is_Pow and not e.args[1].free_symbols and e.args[1].is_Rational:
            unit = visit(e.args[0])
            return unit and times(NONE, unit, Fraction(int(e.args[1].p), int(e.args[1].q)))
        name = e.func.__name__
        if name in ("rate", "diff", "integral", "mean", "at", "conjugate", "re", "im", "Abs"):
            unit = visit(e.args[0])
            if unit is None or name not in ("rate", "diff", "integral"):
                return unit
            if name == "rate":
                return times(unit, time, -int(e.args[1]) if len(e.args) > 1 else -1)
            return times(unit, visit(e.args[1]) or NONE, -1 if name == "diff" else 1)
        if name == "atan2":
            first, second = map(visit, e.args)
            if None not in (first, second) and first != second:
                raise UnitFault(f"atan2 of {e.args[0]} [{told(first)}] and {e.args[1]} [{told(second)}]")
            return NONE
        if isinstance(e, (sp.NumberSymbol, sp.core.numbers.ImaginaryUnit)):
            return NONE
        for argument in e.args:
            unit = visit(argument)
            if any(unit or ()):
                raise UnitFault(f"{e.func.__name__}({argument}): its argument has the unit {told(unit)}")
        return NONE

    return visit(expression)


MOST_EDITS = 900
KEEP = 3
TWINS = {name: tuple(others.split()) for name, others in {
    "sin": "cos tan sinh", "cos": "sin cosh", "tan": "cot sin tanh", "asin": "acos", "acos": "asin",
    "atan": "atanh", "sinh": "cosh tanh sin", "cosh": "sinh cos", "tanh": "tan sinh", "asinh": "acosh atanh",
    "atanh": "asinh atan", "re": "im", "im": "re"}.items()}


def repairs(paper: Paper, row: Row, printed, setting: Setting) -> tuple[str, ...]:
    """Formulas "left = right", one edit away from the printed ones, that pass the row's check (under the
    condition of the setting); at most KEEP."""
    result: list[str] = []
    try:
        trial = _Trial(paper, row, setting)
    except InputError:
        return ()
    for at, (left, right) in enumerate(printed):
        alone = row.kind in ("holds", "order")
        if alone and trial.agrees([(left, right)]):
            continue
        for edited in islice(_edits_of_sides(paper, row, left, right, setting.fixed), MOST_EDITS):
            if edited not in printed and trial.agrees([edited] if alone
                                                      else [*printed[:at], edited, *printed[at + 1:]]):
                result.append(f"{edited[0]} = {edited[1]}")
            if len(result) == KEEP:
                return tuple(result)
    return tuple(result)


class _Trial:
    """Whether formulas pass a row's check: at two points in doubles, then with all digits."""

    def __init__(self, paper: Paper, row: Row, setting: Setting):
        self.paper, self.row, self.setting = paper, row, setting
        every = [s for name, s in paper.symbols.items() if name not in setting.bound | setting.fixed]
        self.points = setting.points(every, row.equation, 2)
        self.values = None  # an evaluator a point: an edit shares most of its parts with the one before

    def agrees(self, printed) -> bool:
        import mpmath

        try:
            if self.row.kind == "holds" and not self._near(printed):
                return False
            pairs = checks.pairs(self.paper, self.row, printed, self.setting)
            if all(left == right for left, right in pairs):
                return False  # an edit that leaves nothing to be said
            rows = [checks.residual(pairs, mpmath.fp, point, self.setting) for point in self.points]
        except (InputError, TypeError, AttributeError, KeyError):
            return False
        if any(r is None or r > 1e-7 for r in rows):
            return False
        return checks.decide(pairs, self.setting, self.row.equation, symbolic=False).holds is True

    def _near(self, printed):
        """Whether doubles leave it open that the formulas hold, without any work on symbols."""
        import mpmath

        if self.values is None:
            ready = [self.setting.settled(mpmath.fp, point) for point in self.points]
            self.values = [self.setting.evaluator(mpmath.fp, item, in_numbers=True) for item in ready]
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

    visited = {(left, right)}
    own = [s for s in sorted(left.free_symbols | right.free_symbols, key=lambda s: s.name)
           if s.name not in fixed]
    targets = [] if left.func.__name__ == "diff" else [(right, lambda e: (left, e))]
    if row.kind not in ("solves", "equilibrium") and (right.is_Number or left.has(sp.Function)):
        targets.append((left, lambda e: (e, right)))
    for factors in (False, True):  # the likelier edits first
        for tree, put in targets:
            for edited in edits(tree, own, paper.symbols, factors):
                pair = put(edited)
                if pair not in visited and pair[0] != pair[1]:
                    visited.add(pair)
                    yield pair


def edits(tree, own, declared, factors):
    """Every tree one edit away. own: symbols of the formula; declared: by name, for indices; factors: those
    with a factor more or less, else the others."""
    if not factors:
        yield -tree
    for index, node in _nodes(tree):
        for other in _with_factors(node, own,
                                   index == ()) if factors else _others(node, own, declared, index == ()):
            yield _replaced(tree, index, other)


def _nodes(tree, location=()):
    yield location, tree
    if tree.func.__name__ in ("rate", "diff", "mean", "at", "integral"):
        if not tree.args[0].is_Symbol:  # the rate of another variable would be another statement
            yield from _nodes(tree.args[0], (*location, 0))
        return
    for n, argument in enumerate(tree.args):
        yield from _nodes(argument, (*location, n))


def _replaced(tree, location, other):
    if not location:
        return other
    n, *rest = location
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


def _with_factors(node: Expr, own: Sequence[Expr], top: bool):
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


def _siblings(symbol: Expr, declared: Mapping[str, Expr]):
    """Declared symbols of the same stem: D2, D3 for D1."""
    stem = re.sub(r"\d+$", "", symbol.name)
    return [s for name, s in declared.items() if s != symbol and name != stem
            and re.sub(r"\d+$", "", name) == stem]


VERDICTS = ("holds", "only-if", "wrong", "definition", "not-checkable")


@dataclass(frozen=True)
class Finding:
    """What the machine says of one row.

    verdict: of VERDICTS; condition: under which it holds, "" if none is known; correction: a formula that
    passes the check which the printed one fails; method: how it was decided; residual: of the printed
    formula; corrected_residual: of the correction; repairs: formulas one edit away that pass; unit_fault: ""
    or which terms differ; judged_by: what the claim speaks of and was held against; exact_motion: whether
    the exact motion does so too, "" where it was held against that.
    """

    row: Row
    verdict: str
    condition: str
    correction: str
    method: str
    residual: float
    corrected_residual: float
    repairs: tuple[str, ...] = ()
    unit_fault: str = ""
    judged_by: str = ""
    exact_motion: str = ""


def audit(paper: Paper, equation: str | None = None,
          tell: Callable[[int, int, str], None] | None = None) -> tuple[Finding, ...]:
    """Findings of a paper's rows, or of one equation, with or without its brackets; else of the rows that
    speak of it, as "G1". tell(done, count, words): before each row."""
    prove_systems(paper)
    rows = list(paper.rows) if equation is None else rows_of(paper, equation)
    if not rows:
        raise InputError(
            f"{paper.name} has no row for equation {equation!r}; it has "
            f"{', '.join(row.equation for row in paper.rows)}")
    result = []
    for done, row in enumerate(rows):
        if tell:
            tell(done, len(rows), f"equation {row.equation}")
        result.append(examine(paper, row))
    return tuple(result)


def rows_of(paper: Paper, equation: str) -> list[Row]:
    """The row of an equation, as of `audit`, else those that speak of it."""
    label = equation.strip().strip("()")
    return ([row for row in paper.rows if row.equation == label]
            or [row for row in paper.rows if re.search(rf"(?<!\w){re.escape(label)}(?!\w)", row.says)])


def prove_systems(paper: Paper) -> None:
    """Every system stated by rates follows from its parent; InputError names one that does not."""
    bound = {name: parse(text, paper.symbols) for name, text in paper.definitions.items()}
    for name, parent, pairs in checks.stated(paper):
        decision = checks.decide(pairs, with_domain(paper, (), pairs, Setting(bound, parent)), name)
        if not decision.holds:
            raise InputError(
                f"{paper.name}, systems.{name}: its rates do not follow from those of its parent "
                f"({decision.method}, residual {decision.residual:.2g})"
            )


def with_domain(paper: Paper, texts, pairs, setting: Setting) -> Setting:
    """The setting with what is positive at the points tried: the row's own domain, and of the paper's all
    that speaks of symbols of these pairs."""
    own = replace(setting, domain=tuple(parse(text, paper.symbols) for text in texts))
    standing, plain = set(checks.free(pairs, own)), Setting(setting.bound)
    shared = (parse(text, paper.symbols) for text in paper.domain)
    return replace(own, domain=(*own.domain, *(d for d in shared
                                               if set(checks.free([(d, d)], plain)) <= standing)))


def examine(paper: Paper, row: Row, search: bool = True) -> Finding:
    """The finding of one row, its numbers computed. search: whether conditions and repairs are looked for.
    InputError where the row cannot be tried, with file and row."""
    row = filled(row)
    return replace(_tried(paper, row, search), judged_by=checks.judged_by(paper, row),
                   exact_motion=checks.of_exact_motion(paper, row))


def _tried(paper: Paper, row: Row, search: bool) -> Finding:
    if row.kind in ("definition", "not-checkable"):
        text = f"defines {row.options['defines']}" if row.kind == "definition" else row.options["because"]
        return Finding(row, row.kind, "", "", text, float("nan"), float("nan"),
                       unit_fault=unit_fault(paper, row))
    if row.kind == "number":
        return Finding(row, *checks.number(paper, row))
    if row.kind == "test":
        return Finding(row, *checks.tested(row))
    return _formula(paper, row, search)


def _formula(paper: Paper, row: Row, search: bool):
    printed = checks.raw(paper, row.printed)
    setting = Setting(checks.bound_of(paper, row), checks.system_of(paper, row.system, row.place))
    pairs = checks.pairs(paper, row, printed, setting)
    setting = with_domain(paper, row.domain, pairs, setting)
    fault, decision = unit_fault(paper, row), _decided(paper, row, pairs, setting)
    if decision.holds is None:
        raise InputError(f"{row.place}: {decision.method}")
    if decision.holds:
        method = decision.method + (f"; units differ: {fault}" if fault else "")
        return Finding(row, "wrong" if fault else "holds", "", "", method, decision.residual, float("nan"),
                       unit_fault=fault)
    (condition, how), (fixes, under) = ("", ""), ((), "")
    if search and row.kind == "order":
        condition, how = _order_condition(paper, row, pairs, setting)
    elif search:
        condition, how = checks.condition_of(paper, row, pairs, setting)
        fixes, under = _fixes(paper, row, printed, pairs, setting, condition)
    correction, corrected_residual = _corrected(paper, row, setting)
    method = (decision.method + (f"; {how} under the condition" if condition else "")
              + ("; correction passes the same check" if correction else ""))
    method += f"; one edit makes it hold{under}" if fixes else ""
    verdict = "only-if" if condition and not fixes and not fault else "wrong"
    return Finding(row, verdict, condition, correction or (*fixes, "")[0], method, decision.residual,
                   corrected_residual, fixes, fault)


def _order_condition(paper, row, pairs, setting):
    """The first single condition under which the remainder is of the claimed order."""
    for text, fixed in checks.singles(paper, row, pairs, setting):
        decision = checks.order(paper, row, pairs, replace(setting, bound=setting.bound | fixed))
        if row.options["small"] not in fixed and decision.holds:
            return text, decision.method
    return "", ""


def _corrected(paper: Paper, row: Row, setting: Setting):
    """(words of the row's correction, its residual), "" where it has none. InputError where it fails the
    check as well."""
    if not row.corrected:
        return "", float("nan")
    setting = replace(setting, bound=checks.bound_of(paper, row, corrected=True))
    pairs = checks.pairs(paper, row, checks.raw(paper, row.corrected), setting)
    better = _decided(paper, row, pairs, setting)
    if not better.holds:
        raise InputError(
            f"{row.place}: the corrected formula fails the check as well ({better.method}, residual "
            f"{better.residual:.2g})")
    where = ", ".join(f"{name} = {text}" for name, text in row.corrected_where.items())
    return "; ".join(row.corrected) + (f" with {where}" if where else ""), better.residual


def _fixes(paper, row, printed, pairs, setting, condition):
    """(formulas one edit away that pass, "" or the condition that they need): a misprint is wrong even where
    a condition hides it.

    Under a condition they are looked for only where no single one helps the printed formula.
    """
    if row.options.get("repair") is False:
        return (), ""
    fixes = repairs(paper, row, printed, setting)
    if fixes or (condition and " and " not in condition):
        return fixes, ""
    for text, fixed in checks.singles(paper, row, pairs, setting):
        if text in (condition or text) and (fixes := repairs(paper, row, printed,
                                                               replace(setting, fixed=fixed))):
            return tuple(f"{fix} (where {text})" for fix in fixes), f" where {text}"
    return (), ""


def _decided(paper: Paper, row: Row, pairs: Sequence[tuple[Expr, Expr]], setting: Setting) -> checks.Decision:
    return (checks.order(paper, row, pairs, setting) if row.kind == "order"
            else checks.decide(pairs, setting, row.equation))
