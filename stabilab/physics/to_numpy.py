"""From symbols to numbers: the one gate to NumPy and to heyoka's Taylor series.

An expression that is polynomial in the state keeps its monomials; each coefficient is formed from the exact
parameters and rounded once (D2 - D3 of two nearly equal moments keeps all its digits), so the compiled code
depends on the monomials alone and is shared by all scenes of the same structure within a process.
"""
from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property, lru_cache
from itertools import accumulate, chain, pairwise
from threading import RLock
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np

from ..errors import InputError
from .equations import Equations, Symbolic, derive, values
from .scene import AnyScene, HashedOnce

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

Known: TypeAlias = tuple[tuple[Symbolic, Symbolic], ...]  # parameters and their numbers


@dataclass(frozen=True)
class Structure(HashedOnce):
    """What a form has beside its numbers: code is compiled once for all scenes of one structure."""

    state: tuple[Symbolic, ...]
    symbols: tuple[Symbolic, ...]
    expressions: tuple[Symbolic, ...]

    __hash__ = HashedOnce.__hash__


@dataclass(frozen=True)
class Form:
    """Expressions in the state and in coefficient symbols c0, c1, ... with the numbers behind those."""

    state: tuple[Symbolic, ...]
    expressions: tuple[Symbolic, ...]
    symbols: tuple[Symbolic, ...]
    numbers: tuple[float, ...]

    @cached_property
    def structure(self) -> Structure:
        """Itself without the numbers."""
        return Structure(self.state, self.symbols, self.expressions)

    @cached_property
    def function(self) -> Callable[..., Any]:
        """The values from those of the state and of the coefficients, in NumPy."""
        return _function(self.state + self.symbols, self.expressions)


def form(equations: Equations, expressions: Iterable[Symbolic], drop_constants: bool = False) -> Form:
    """Expressions with one numbered coefficient per monomial; monomials whose coefficient is exactly 0
    vanish."""
    return _form(equations.state, _known(equations), tuple(expressions), drop_constants)


@lru_cache(maxsize=64)
def _known(equations: Equations) -> Known:
    return tuple(values(equations).items())


@lru_cache(
    maxsize=128)  # a comparison asks for the same scene dozens of times, and this is most of a short run
def _form(state: tuple[Symbolic, ...], resolved: Known, expressions: tuple[Symbolic, ...],
          drop_constants: bool) -> Form:
    numbers_of = dict(resolved)
    symbols: list[Symbolic] = []
    numbers: list[float] = []
    named: dict[Symbolic, Symbolic] = {}
    result = []
    for expression in expressions:
        terms = _terms(expression, state, resolved)
        if terms is None:
            result.append(_unstructured(expression, numbers_of, named, symbols, numbers))
            continue
        full = _whole(expression, state, tuple(numbers_of)) if any(c.is_Integer for _, c in terms) else {}
        total = expression * 0
        for powers, coefficient in terms:
            if coefficient == 0 or (drop_constants and not any(powers)):
                continue
            own = (coefficient if full.get(powers) == coefficient
                   else _numbered(_rounded(coefficient), symbols, numbers))
            total += own * _monomial(state, powers)
        result.append(total)
    return Form(state, tuple(result), tuple(symbols), tuple(numbers))


def _terms(expression: Symbolic, state: tuple[Symbolic, ...],
           resolved: Known) -> list[tuple[tuple[int, ...], Symbolic]] | None:
    """(powers, number) of each monomial of the state at these values of the parameters; None of what is no
    polynomial in the state."""
    from sympy import Poly, PolynomialError
    number = expression.xreplace(dict(resolved))
    if not number.is_polynomial(*state):  # by its form: Poly would first expand it, for minutes
        return None
    try:
        return Poly(number, *state).terms()
    except PolynomialError:
        return None


@lru_cache(maxsize=512)  # scenes of one structure have the same expressions, and other numbers
def _whole(expression: Symbolic, state: tuple[Symbolic, ...],
           parameters: tuple[Symbolic, ...]) -> dict[tuple[int, ...], Symbolic]:
    """The coefficients of a polynomial that are whole numbers for any parameters, as they are for these,
    which have nothing to do with one another."""
    from sympy import Rational
    others = tuple((item, Rational(1009 + 617 * n**3, 1013 + n)) for n, item in enumerate(parameters))
    return {powers: c for powers, c in _terms(expression, state, others) or () if c.is_Integer}


def _monomial(state: Sequence[Symbolic], powers: Sequence[int]) -> Symbolic:
    from sympy import prod
    return prod(x**n for x, n in zip(state, powers))


def _unstructured(expression: Symbolic, resolved: dict[Symbolic, Symbolic],
                  named: dict[Symbolic, Symbolic], symbols: list[Symbolic], numbers: list[float]) -> Symbolic:
    """An expression that is no polynomial in the state: every parameter and every ratio in it becomes a
    number. named: parameter -> the number that it has in the expressions before, and so in this one: what
    they have in common is formed once."""
    from sympy import Float, Rational
    for p in (p for p in resolved if p in expression.free_symbols and p not in named):
        named[p] = _numbered(_rounded(resolved[p]), symbols, numbers)
    swapped = expression.xreplace(named)  # each for itself: a search for what it may stand in takes seconds
    return swapped.xreplace({r: Float(r, 17) for r in swapped.atoms(Rational) if not r.is_Integer})


def _numbered(number: float, symbols: list[Symbolic], numbers: list[float]) -> Symbolic:
    from sympy import Symbol
    symbols.append(Symbol(f"c{len(symbols)}", real=True))
    numbers.append(number)
    return symbols[-1]


def _rounded(exact: Symbolic) -> float:
    try:
        return float(Fraction(int(exact.p), int(exact.q))) if exact.is_Rational else float(exact.evalf(30))
    except OverflowError:
        raise InputError("a number of the equations or of their laws (the square of a moment, say) is beyond "
                         "the largest double: choose other units") from None


@dataclass(frozen=True)
class System:
    """A scene's equations as numbers, each part formed where it is asked for. Arrays: batch first, component
    last; any float or complex type."""

    equations: Equations

    @cached_property
    def rhs(self) -> Form:
        """Rates of the state: what an integrator steps."""
        return form(self.equations, self.equations.rhs)

    @cached_property
    def entries(self) -> Form:
        """The Jacobian's, row by row."""
        return form(self.equations, self.equations.jacobian)

    @cached_property
    def quantities(self) -> Form:
        """The laws', up to additive constants."""
        return form(self.equations, [law.quantity for law in self.equations.balances], drop_constants=True)

    @cached_property
    def rates(self) -> Form:
        """Those of the laws' quantities."""
        return form(self.equations, [law.rate for law in self.equations.balances])

    @cached_property
    def motion_and_laws(self) -> Form:
        """`rhs`, and the rates of the laws' quantities with it."""
        return form(self.equations, (*self.equations.rhs, *(law.rate for law in self.equations.balances)))

    @cached_property
    def motion_and_rates(self) -> Form:
        """`rhs`, and the rates once more: what an integrator steps that looks for their roots."""
        return form(self.equations, (*self.equations.rhs, *self.equations.rhs))

    def __call__(self, x: ArrayLike) -> np.ndarray:
        """Rates of the states x: (..., 3) -> (..., 3)."""
        return evaluate(self.rhs, x)

    def rate(self, x: Sequence[float]) -> list[float]:
        """Rates of one state given as a list of three plain floats, as a list (no array overhead)."""
        return _call(self.rhs, x)

    def rate_and_laws(self, x: Sequence[float]) -> list[float]:
        """`rate` followed by the rates of the laws, as one list."""
        return _call(self.rhs, x) + _call(self.rates, x)

    def jacobian(self, x: ArrayLike) -> np.ndarray:
        """d rate_i / d x_j: (..., 3) -> (..., 3, 3)."""
        flat = evaluate(self.entries, x)
        n = len(self.equations.state)
        return flat.reshape(flat.shape[:-1] + (n, n))

    def invariants(self, x: ArrayLike) -> dict[str, np.ndarray]:
        """Law name -> its quantity (up to an additive constant) at the states x: (..., 3) -> (...)."""
        flat = evaluate(self.quantities, x)
        return {law.name: flat[..., i] for i, law in enumerate(self.equations.balances)}

    def law_rates(self, x: ArrayLike) -> dict[str, np.ndarray]:
        """Law name -> rate of its quantity at the states x: (..., 3) -> (...)."""
        flat = evaluate(self.rates, x)
        return {law.name: flat[..., i] for i, law in enumerate(self.equations.balances)}

    def laws(self, x: ArrayLike) -> tuple[np.ndarray, np.ndarray]:
        """(quantities as of `invariants`, the sums of their absolute terms, which a relative departure is
        measured against), in the order of the equations' balances: (..., 3) -> two of (laws, ...)."""
        terms, ends = self._law_terms
        each = _values(terms, x, first=True)
        quantities, sizes = np.empty((2, len(ends), *each.shape[1:]), each.dtype)
        for law, (first, last) in enumerate(ends):
            np.add.reduce(each[first:last], axis=0, out=quantities[law])
        np.abs(each, out=each)
        for law, (first, last) in enumerate(ends):
            np.add.reduce(each[first:last], axis=0, out=sizes[law])
        return quantities, sizes

    @cached_property
    def _law_terms(self) -> tuple[Form, list[tuple[int, int]]]:
        """(the terms of all laws' quantities in a row, where those of each begin and end)."""
        from sympy import Add
        form = self.quantities
        terms = [Add.make_args(expression) for expression in form.expressions]
        ends = list(accumulate(map(len, terms), initial=0))
        return Form(form.state, tuple(chain(*terms)), form.symbols, form.numbers), list(pairwise(ends))


def to_numpy(equations: Equations | AnyScene) -> System:
    """The compiled system of derived equations (or of a scene), made once for one and the same equations."""
    return _system(equations_of(equations))


@lru_cache(maxsize=64)
def _system(equations: Equations) -> System:
    return System(equations)


def equations_of(equations_or_scene: Equations | AnyScene) -> Equations:
    return equations_or_scene if isinstance(equations_or_scene, Equations) else derive(equations_or_scene)


@lru_cache(maxsize=256)
def _function(arguments: tuple[Symbolic, ...], expressions: tuple[Symbolic, ...]) -> Callable[..., Any]:
    written, different = extent(expressions)
    return lambdified(arguments, list(expressions), cse=written > REPEATED * different)


REPEATED = 4  # times that an expression stands in others on average: then it is formed once


def extent(expressions: Iterable[Symbolic]) -> tuple[int, int]:
    """(how many subexpressions stand there written out, how many of them differ)."""
    sizes: dict[Any, int] = {}

    def size(item: Any) -> int:
        if item not in sizes:
            sizes[item] = 1 + sum(map(size, item.args))
        return sizes[item]
    return sum(map(size, expressions)), len(sizes)


def lambdified(arguments: Sequence[Symbolic], expressions: Sequence[Symbolic],
               cse: bool = False) -> Callable[..., Any]:
    """The expressions as one function of NumPy's arrays, made by one thread at a time: a second one would
    find the names that SymPy collects for the first function half collected."""
    from sympy import lambdify
    with _NAMES:
        # of the word "numpy" SymPy would make a star import, which loads NumPy's tests
        return lambdify(arguments, expressions, [np], cse=cse)


_NAMES = RLock()


def _call(form: Form, x: Sequence[float]) -> list[float]:
    return form.function(*x, *form.numbers)


def evaluate(form: Form, x: ArrayLike) -> np.ndarray:
    """Values of the form at x (..., 3), one per expression in the last place; constants are spread over the
    batch."""
    return _values(form, x)


def _values(form: Form, x: ArrayLike, first: bool = False) -> np.ndarray:
    """`evaluate`; first: one per expression in the first place."""
    x = np.asarray(x)
    x = x if x.dtype.kind in "fc" else x.astype(float)
    count, batch = len(form.expressions), x.shape[:-1]
    out = np.empty((count, *batch) if first else (*batch, count), x.dtype)
    # NumPy's moveaxis takes as long as the sums of a short run
    columns = x.T if x.ndim < 3 else np.moveaxis(x, -1, 0)
    for i, value in enumerate(form.function(*columns, *form.numbers)):
        out[i if first else (..., i)] = value
    return out
