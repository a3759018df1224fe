"""Printed formulas evaluated: at points, with derivatives and to any number of digits, for the audit, and as
functions of NumPy arrays, so that what `model = "printed"` draws is what the audit compares with the
equations of motion."""
from __future__ import annotations

import cmath
import random
import zlib
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ...errors import InputError
from ...physics.to_numpy import lambdified
from .claims import FOLDER, parse, vocabulary

if TYPE_CHECKING:
    from sympy import Expr

# --- Values of formulas at random points, to any number of digits: what decides where symbols do not
FUNCTION_NAMES = {"Abs": "fabs", "conjugate": "conj", "log": "ln"}
MEAN_POINTS = 48  # equally spaced angles: exact for harmonics below 48


def precise(digits: int):
    """An mpmath context of its own with so many digits: mpmath's common one has its precision for the whole
    process."""
    import mpmath
    numbers = mpmath.MPContext()
    numbers.dps = digits
    return numbers


class Undefined(Exception):
    """The formula has no value at the point: division by zero, a logarithm of it."""


class Evaluator:
    """Values of raw formulas at one point.

    numbers: an mpmath context (`mpmath.fp`, or `mpmath.mp` whose digits the caller sets); point: symbol name
    -> value; bound: symbol name -> SymPy expression it stands for (definitions, `where`); system: whose
    `rate` the operator asks for, or None. in_numbers: `at`, `mean` and `integral` put numbers in place of
    their symbol, where else SymPy puts in all that stands for another symbol first: quick for many formulas
    that share most of their parts, but a division by zero is not cancelled. beside_point: the values are
    those of a difference quotient, and derivatives in them are taken by symbols.
    """

    def __init__(self, numbers, point: dict, bound: dict, system, in_numbers: bool = False,
                 beside_point: bool = False):
        self.numbers, self.point, self.bound = numbers, point, bound
        self.system, self.in_numbers, self.beside_point = system, in_numbers, beside_point
        self.known: dict = {}   # expression -> value
        self._beside: dict = {}  # what differs -> evaluator that has the same but for that

    def beside(self, key: str, make: Callable[[], _Quotient]):
        """The evaluator kept under a key, made where there is none: what it has found once serves the next
        formula."""
        if key not in self._beside:
            self._beside[key] = make()
        return self._beside[key]

    def moved(self, name, value):
        """The same with another value of one symbol."""
        return self.beside((name, value),
                           lambda: Evaluator(self.numbers, self.point | {name: value}, self.bound,
                                             self.system, True))

    def __call__(self, expression: Expr):
        if expression in self.known:
            return self.known[expression]
        try:
            value = self._value(expression)
        except (ZeroDivisionError, ValueError, OverflowError):
            raise Undefined(str(expression)) from None
        if value != value:
            raise Undefined(str(expression))
        self.known[expression] = value
        return value

    def _value(self, e):
        numbers = self.numbers
        if e.is_Rational:
            return numbers.mpf(int(e.p)) / int(e.q)
        if e.is_Symbol:
            return self(self.bound[e.name]) if e.name in self.bound else self._known(e.name)
        if e.is_Add:
            return sum((self(a) for a in e.args[1:]), self(e.args[0]))
        if e.is_Mul:
            out = self(e.args[0])
            for factor in e.args[1:]:
                out = out * self(factor)
            return out
        if e.is_Pow:
            base, power = e.args
            if power.is_Integer:
                return self(base) ** int(power)
            if power.is_Rational and power.q == 2:
                return numbers.sqrt(self(base)) ** int(power.p)
            return numbers.power(self(base), self(power))
        name = e.func.__name__
        if name in OPERATORS:
            return OPERATORS[name](self, *e.args)
        if name == "exp":
            return numbers.exp(self(e.args[0]))
        if name == "ImaginaryUnit":
            return numbers.mpc(0, 1)
        if name == "Pi":
            return +numbers.pi
        if name == "Exp1":
            return numbers.exp(numbers.mpf(1))
        if name in ("Integral", "Subs"):
            raise InputError(f"cannot evaluate {e}")
        name = FUNCTION_NAMES.get(name, name)
        return getattr(numbers, name, getattr(cmath, name, None))(*map(self, e.args))

    def _known(self, name: str):
        if name not in self.point:
            raise InputError(f"symbol {name!r} has no value")
        return self.point[name]

    def plain(self, e: Expr):
        """The expression with bound symbols put in and every operator carried out, as far as SymPy can."""
        e = e.xreplace({s: self.plain(self.bound[s.name]) for s in e.free_symbols if s.name in self.bound})
        return self.carried(e)

    def carried(self, e):
        """The expression with every rate along the motion carried out."""
        return (e.replace(lambda f: f.func.__name__ == "rate", lambda f: _rate_of(self, f)) if operated(e)
                else e)


def operated(e) -> bool:
    """Whether an operator (rate, diff, at, mean, integral) stands in a formula."""
    return not e.is_Atom and _operated(e)


@lru_cache(maxsize=1 << 16)
def _operated(e):
    return e.func.__name__ in OPERATORS or any(operated(a) for a in e.args)


def _rate_of(evaluator, f):
    if evaluator.system is None:
        raise InputError("rate(...) needs a system: name one in the row")
    own = {name: e for name, e in evaluator.bound.items()
           if name not in {x.name for x in evaluator.system.state}}
    # the state moves by the system, whatever stands for it in the row
    expression = Evaluator(None, {}, own, evaluator.system).plain(f.args[0])
    for _ in range(int(f.args[1]) if len(f.args) > 1 else 1):
        expression = evaluator.system.rate(expression)
    return expression


def _rate(evaluator: Evaluator, f: Expr, n: int = 1):
    """By a difference quotient where that is enough, else by symbols."""
    import sympy as sp
    if n != 1 or f.has(sp.Function("rate")) or evaluator.beside_point:
        return evaluator(_rate_of(evaluator, sp.Function("rate")(f, n)))
    if evaluator.system is None:
        raise InputError("rate(...) needs a system: name one in the row")
    return evaluator.beside("rate", lambda: _along(evaluator))(f)


def _along(evaluator: Evaluator):
    """Derivatives along the motion."""
    state = {x.name: x for x in evaluator.system.state}
    bound = {name: e for name, e in evaluator.bound.items() if name not in state}
    return _Quotient(evaluator, bound, {name: evaluator(x) for name, x in state.items()},
                     dict(zip(state, map(evaluator, evaluator.system.rates))))


def _diff(evaluator, f, s, n=1):
    if n != 1 or evaluator.beside_point or operated(f):
        return evaluator(evaluator.plain(f).diff(s, int(n)))
    return evaluator.beside(("diff", s.name), lambda: _Quotient(
        evaluator, evaluator.bound, {s.name: evaluator(s)}, {s.name: 1}))(f)


class _Quotient:
    """Derivatives where the symbols of `slopes` change at those rates, by the values a step ahead and one
    behind: with half as many digits more, so that all digits of the evaluator are right; of doubles ten."""

    def __init__(self, evaluator, bound, values, slopes):
        import mpmath
        self.numbers = own = evaluator.numbers
        numbers = own if own is mpmath.fp else precise(own.dps + own.dps // 2 + 12)
        self.step = 6e-6 if own is mpmath.fp else numbers.mpf(10) ** -(own.dps // 2 + 4)
        here, slopes = ({name: numbers.convert(value) for name, value in table.items()}
                        for table in (evaluator.point | values, slopes))
        self.sides = [Evaluator(numbers, here | {name: here[name] + step * slope
                                                 for name, slope in slopes.items()},
                                bound, evaluator.system, beside_point=True)
                      for step in (self.step, -self.step)]

    def __call__(self, f: Expr):
        ahead, behind = (side(f) for side in self.sides)
        return +self.numbers.convert((ahead - behind) / (2 * self.step))


def _at(evaluator, f, s, value):
    if evaluator.in_numbers and not evaluator.beside_point:
        try:
            return evaluator.moved(s.name, evaluator(value))(f)
        except Undefined:
            pass  # what SymPy cancels, it may have
    f = evaluator.plain(f).replace(lambda e: e.func.__name__ == "diff",
                                   lambda e: evaluator.plain(e.args[0]).diff(*e.args[1:]))
    return evaluator(f.subs(s, value))


def _moved(evaluator, f, s):
    """f as a function of one symbol, the others as they are."""
    if evaluator.in_numbers and not evaluator.beside_point:
        return lambda value: evaluator.moved(s.name, value)(f)
    f = evaluator.plain(f)

    def of(value):
        return Evaluator(evaluator.numbers, evaluator.point | {s.name: value}, {}, evaluator.system)(f)

    return of


def _mean(evaluator, f, angle):
    of, numbers = _moved(evaluator, f, angle), evaluator.numbers
    return sum(of(2 * numbers.pi * n / MEAN_POINTS) for n in range(MEAN_POINTS)) / MEAN_POINTS


def _integral(evaluator, f, s, low, high):
    return evaluator.numbers.quad(_moved(evaluator, f, s), [evaluator(low), evaluator(high)])


OPERATORS = {"rate": _rate, "diff": _diff, "at": _at, "mean": _mean, "integral": _integral}


@dataclass(frozen=True)
class Setting:
    """What formulas are tried on. bound: symbol name -> the SymPy expression that it stands for; system: the
    motion along which rates are taken, or None; domain: expressions that are positive; fixed: symbol name ->
    expression of the others (a condition)."""

    bound: dict
    system: Any = None
    domain: tuple = ()
    fixed: dict = field(default_factory=dict)

    def evaluator(self, numbers=None, point: dict | None = None, in_numbers: bool = False) -> Evaluator:
        """Values at a point; without one, what symbols alone can carry out."""
        return Evaluator(numbers, point or {}, self.bound, self.system, in_numbers)

    def points(self, symbols: Sequence[Expr], seed_text: str, count: int) -> list[dict]:
        """`count` random rational points: symbol name -> Fraction (pairs for complex symbols), sizes 1/3 to
        3, where every expression of the domain is positive. InputError where it is not met in many tries."""
        import mpmath

        draw, out = random.Random(zlib.crc32(seed_text.encode())), []
        for _ in range(400 * count):
            point = {s.name: _random(draw, s) for s in symbols}
            ready = self.settled(mpmath.fp, point)
            if ready is None:
                continue
            try:
                if all(_positive(self.evaluator(mpmath.fp, ready)(d)) for d in self.domain):
                    out.append(point)
            except Undefined:
                continue
            if len(out) == count:
                return out
        raise InputError(f"no point found at which all of {', '.join(map(str, self.domain))} are positive")

    def settled(self, numbers, point: dict) -> dict | None:
        """The point as numbers of a kind, fixed symbols by their expressions; None where these have no value.
        """
        values = {
            name: numbers.mpc(*(numbers.mpf(p.numerator) / p.denominator for p in value))
            if isinstance(value, tuple)
            else numbers.mpf(value.numerator) / value.denominator
            for name, value in point.items()
        }
        for name, expression in self.fixed.items():
            try:
                values[name] = self.evaluator(numbers, values)(expression)
            except Undefined:
                return None
        return values


def _random(draw: random.Random, symbol: Expr):
    size = lambda: Fraction(draw.randrange(334, 3000), 1000)
    if symbol.is_positive:
        return size()
    if symbol.is_real:
        return size() * draw.choice((1, -1))
    return size() * draw.choice((1, -1)), size() * draw.choice((1, -1))


def _positive(value: float):
    return abs(value.imag) < 1e-12 and value.real > 1e-9


@lru_cache
def printed_formulas(paper: str) -> PrintedFormulas:
    """The formulas of a paper on record, by the name of its file without `.toml`."""
    return PrintedFormulas(FOLDER / f"{paper}.toml")


class PrintedFormulas:
    """The [formulas] of a paper's file, each called by its name with the values of the symbols that stand in
    it."""

    def __init__(self, path: Path):
        self.symbols, self.formulas, definitions = vocabulary(path)
        bound = {name: parse(text, self.symbols) for name, text in definitions.items()}
        self._plain = Evaluator(None, {}, bound, None).plain
        self._made: dict = {}

    def __call__(self, name: str, values: dict, **more):
        """The value of a formula; values, more: symbol name -> number or array, of which it takes those that
        stand in it. KeyError for one that is missing."""
        if name not in self._made:
            expression = self._plain(parse(self.formulas[name], self.symbols))
            names = sorted(s.name for s in expression.free_symbols)
            self._made[name] = names, lambdified([self.symbols[n] for n in names], expression)
        names, function = self._made[name]
        return function(*(more[n] if n in more else values[n] for n in names))
