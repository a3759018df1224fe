"""From symbols to numbers: the one gate to NumPy and to heyoka's Taylor series.

An expression that is polynomial in the state keeps its monomials; each coefficient is formed from the exact
parameters and rounded once (D2 - D3 of two nearly equal moments keeps all its digits), so the compiled code depends
on the monomials alone and is shared by all scenes of the same structure within a process.
"""
from __future__ import annotations

from contextlib import contextmanager
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property, lru_cache
from threading import RLock

import numpy as np

from .equations import derive, Equations
from ..errors import InputError

# Default tolerance of the Taylor series: half an ulp of 1. In a spin-up the phase grows as t^2, so a relative 1e-12
# per step would cost 2e-5 at t = 1000; a tighter step costs a few per cent.
TAYLOR_TOLERANCE = 2.0**-53
# Quadratures ride along scaled by this power of two (exact), too small ever to steer the step size.
FEATHER = 2.0**-300


def heyoka_available() -> bool:
    """Whether the Taylor integrator is installed (Linux wheels only); SciPy stands in where it is not."""
    try:
        import heyoka  # noqa: F401
    except ImportError:
        return False
    return True


@dataclass(frozen=True)
class Form:
    """Expressions in the state and in coefficient symbols c0, c1, ... with the numbers behind those."""

    state: tuple
    expressions: tuple
    symbols: tuple
    numbers: tuple[float, ...]

    @property
    def varying(self) -> tuple[bool, ...]:
        """Which of the expressions depend on the state."""
        return tuple(bool(e.free_symbols & set(self.state)) for e in self.expressions)


def form(equations: Equations, expressions, drop_constants=False) -> Form:
    """Expressions with one numbered coefficient per monomial; monomials whose coefficient is exactly 0 vanish."""
    return _form(equations.state, _known(equations), tuple(expressions), drop_constants)


@lru_cache(maxsize=64)
def _known(equations) -> tuple:
    from .equations import values
    return tuple(values(equations).items())


@lru_cache(maxsize=128)  # a comparison asks for the same scene dozens of times, and this is most of a short run
def _form(state, known, expressions, drop_constants) -> Form:
    from sympy import Poly, PolynomialError
    known, symbols, numbers, result = dict(known), [], [], []
    for expression in expressions:
        try:
            terms = Poly(expression, *state).terms()
        except PolynomialError:
            result.append(_unstructured(expression, known, symbols, numbers))
            continue
        total = expression * 0
        for powers, factor in terms:
            if not (drop_constants and not any(powers)):
                total += _coefficient(factor, known, symbols, numbers) * _monomial(state, powers)
        result.append(total)
    return Form(state, tuple(result), tuple(symbols), tuple(numbers))


def _monomial(state, powers):
    from sympy import prod
    return prod(x**n for x, n in zip(state, powers))


def _coefficient(factor, known, symbols, numbers):
    """A symbol for the coefficient (its number rounded once), 0 where it vanishes, the integer itself where it is one."""
    from sympy import Integer
    if factor.is_Integer:
        return factor
    exact = factor.subs(known)
    return Integer(0) if exact.is_zero else _numbered(_rounded(exact), symbols, numbers)


def _unstructured(expression, known, symbols, numbers):
    """An expression that is no polynomial in the state: every parameter and every ratio in it becomes a number."""
    from sympy import Float, Rational
    swap = {p: _numbered(_rounded(v), symbols, numbers) for p, v in known.items() if expression.has(p)}
    swapped = expression.subs(swap)
    return swapped.subs({r: Float(r, 17) for r in swapped.atoms(Rational) if not r.is_Integer})


def _numbered(number, symbols, numbers):
    from sympy import Symbol
    symbols.append(Symbol(f"c{len(symbols)}", real=True))
    numbers.append(number)
    return symbols[-1]


def _rounded(exact) -> float:
    try:
        return float(Fraction(int(exact.p), int(exact.q))) if exact.is_Rational else float(exact.evalf(30))
    except OverflowError:
        raise InputError("a number of the equations or of their laws (the square of a moment, say) is beyond the largest double: "
                         "choose other units") from None


@dataclass(frozen=True)
class System:
    """A scene's equations as numbers. Arrays: batch first, component last; any float or complex type."""

    equations: Equations
    rhs: Form
    entries: Form
    quantities: Form
    rates: Form

    def __call__(self, x):
        """Rates of the states x: (..., 3) -> (..., 3)."""
        return _evaluate(self.rhs, x)

    def rate(self, x) -> list:
        """Rates of one state given as a list of three plain floats, as a list (no array overhead)."""
        return _call(self.rhs, x)

    def rate_and_laws(self, x) -> list:
        """`rate` followed by the rates of the laws, as one list."""
        return _call(self.rhs, x) + _call(self.rates, x)

    def jacobian(self, x):
        """d rate_i / d x_j: (..., 3) -> (..., 3, 3)."""
        flat = _evaluate(self.entries, x)
        n = len(self.equations.state)
        return flat.reshape(flat.shape[:-1] + (n, n))

    def invariants(self, x) -> dict:
        """Law name -> its quantity (up to an additive constant) at the states x: (..., 3) -> (...)."""
        flat = _evaluate(self.quantities, x)
        return {law.name: flat[..., i] for i, law in enumerate(self.equations.balances)}

    def law_rates(self, x) -> dict:
        """Law name -> rate of its quantity at the states x: (..., 3) -> (...)."""
        flat = _evaluate(self.rates, x)
        return {law.name: flat[..., i] for i, law in enumerate(self.equations.balances)}

    def law_sizes(self, x) -> dict:
        """Law name -> sum of the absolute terms of its quantity: what a relative departure is measured against."""
        return {name: sizes for name, (_, sizes) in self.law_values(x).items()}

    def law_values(self, x) -> dict:
        """Law name -> (`invariants`, `law_sizes`) at the states x, each term formed once: (..., 3) -> two of (...)."""
        x = np.asarray(x)
        columns, nothing, found = np.moveaxis(x, -1, 0).copy(), np.zeros(x.shape[:-1]), {}
        for name, terms in self._law_terms.items():
            each = _function(terms.state + terms.symbols, terms.expressions)(*columns, *terms.numbers)
            found[name] = sum(each, nothing), sum(map(np.abs, each), nothing)
        return found

    @cached_property
    def _law_terms(self) -> dict:
        from sympy import Add
        form = self.quantities
        return {law.name: Form(form.state, Add.make_args(expression), form.symbols, form.numbers)
                for law, expression in zip(self.equations.balances, form.expressions)}


def to_numpy(equations: Equations) -> System:
    """The compiled system of derived equations (or of a scene), made once for one and the same equations."""
    return _system(_equations(equations))


@lru_cache(maxsize=64)
def _system(equations) -> System:
    laws = equations.balances
    return System(equations, form(equations, equations.rhs), form(equations, list(equations.jacobian)),
                  form(equations, [law.quantity for law in laws], drop_constants=True),
                  form(equations, [law.rate for law in laws]))


def _equations(equations_or_scene) -> Equations:
    return equations_or_scene if isinstance(equations_or_scene, Equations) else derive(equations_or_scene)


@lru_cache(maxsize=256)
def _function(arguments, expressions):
    return lambdified(arguments, list(expressions))


def lambdified(arguments, expressions, cse=False):
    """The expressions as one function of NumPy's arrays, made by one thread at a time: a second one would find the names that
    SymPy collects for the first function half collected."""
    from sympy import lambdify
    with _NAMES:
        return lambdify(arguments, expressions, "numpy", cse=cse)


_NAMES = RLock()


def _call(form: Form, x) -> list:
    return _function(form.state + form.symbols, form.expressions)(*x, *form.numbers)


def _evaluate(form: Form, x):
    """Values of the form at x (..., 3), one per expression in the last place; constants are spread over the batch."""
    x = np.asarray(x)
    x = x if np.issubdtype(x.dtype, np.inexact) else x.astype(float)
    out = np.empty(x.shape[:-1] + (len(form.expressions),), x.dtype)
    function = _function(form.state + form.symbols, form.expressions)
    for i, value in enumerate(function(*np.moveaxis(x, -1, 0), *form.numbers)):
        out[..., i] = value
    return out


def to_taylor(equations: Equations, quadratures=(), tolerance: float = TAYLOR_TOLERANCE):
    """A heyoka integrator at t = 0 whose state is the scene's, followed by FEATHER times one integral per quadrature.

    quadratures: SymPy expressions of the state, integrated alongside without steering the step. Raises ImportError
    where heyoka is not installed (ask `heyoka_available` first).
    """
    import copy
    equations = _equations(equations)
    everything = form(equations, (*equations.rhs, *quadratures))
    integrator = copy.copy(_integrator(everything.state, everything.symbols, everything.expressions, tolerance))
    integrator.pars[:] = everything.numbers
    return integrator


@contextmanager
def borrowed_taylor(forms: Form, tolerance: float = TAYLOR_TOLERANCE, lanes: int = 0):
    """Context giving an integrator as `to_taylor` makes them, which goes back for the next user: copying one takes
    longer than some hundred steps. Its time and state are those of its last user: set them.

    forms: `form(equations, (*rhs, *quadratures))`. lanes: 0, or how many motions step together (state, pars and the
    rest are then (..., lanes)). An integrator whose user failed is not handed on.
    """
    import copy
    key = (forms.state, forms.symbols, forms.expressions, tolerance, lanes)
    free = _free(*key)
    try:
        integrator = free.pop()  # one operation: safe among threads
    except IndexError:
        integrator = copy.copy(_integrator(*key))
    integrator.pars[:] = np.reshape(forms.numbers, (-1, 1)) if lanes else forms.numbers
    yield integrator
    if len(free) < MOST_FREE:
        free.append(integrator)


MOST_FREE = 8


@lru_cache(maxsize=64)
def _free(state, symbols, expressions, tolerance, lanes) -> list:
    """The integrators of this kind that nobody uses."""
    return []


@contextmanager
def taylor_events(event_forms: Form, tolerance: float = TAYLOR_TOLERANCE):
    """Context giving (integrator, found): a heyoka integrator that notes every root of every event it passes.

    event_forms: `form(equations, (*rhs, *events))`, the rates first. found: list of (time, index of event, state),
    emptied at the start. The integrator is shared within the process and held by a lock: set its time and state.
    """
    with _LOCK:
        integrator, recorder = _event_integrator(event_forms.state, event_forms.symbols, event_forms.expressions, tolerance)
        integrator.pars[:] = event_forms.numbers[:len(integrator.pars)]  # constant events, which are left out, may hold the last
        recorder.found.clear()
        yield integrator, recorder.found


_LOCK = RLock()


class _Recorder:
    def __init__(self):
        self.found = []

    def __deepcopy__(self, memo):  # heyoka copies its callbacks; the list must stay the same one
        return self


@dataclass(frozen=True)
class _Note:
    """Callback of one event."""

    index: int
    recorder: _Recorder
    size: int

    def __call__(self, integrator, time, sign):
        integrator.update_d_output(time)
        self.recorder.found.append((time, self.index, integrator.d_output[:self.size].copy()))


def _heyoka_form(state, symbols, expressions):
    import heyoka
    variables = heyoka.make_vars(*map(str, state))
    swap = dict(zip(state, variables)) | {s: heyoka.par[i] for i, s in enumerate(symbols)}
    return variables, [_from_sympy(heyoka, e, swap) for e in expressions]


def _from_sympy(heyoka, expression, swap):
    """heyoka.from_sympy turns away ratios and lone numbers; `form` has left only integers and symbols."""
    return heyoka.expression(float(expression)) if expression.is_number else heyoka.from_sympy(expression, swap)


@lru_cache(maxsize=64)
def _integrator(state, symbols, expressions, tolerance, lanes=0):
    import heyoka
    n = len(state)
    variables, rates = _heyoka_form(state, symbols, expressions)
    extra = heyoka.make_vars(*(f"quadrature{i}" for i in range(len(expressions) - n))) if len(expressions) > n else []
    extra = extra if isinstance(extra, list) else [extra]
    rates[n:] = [FEATHER * r for r in rates[n:]]
    make, shape = (heyoka.taylor_adaptive_batch, (lanes,)) if lanes else (heyoka.taylor_adaptive, ())
    return make(list(zip([*variables, *extra], rates)), np.zeros((len(expressions), *shape)),
                pars=np.zeros((len(symbols), *shape)), tol=tolerance)


@lru_cache(maxsize=64)
def _event_integrator(state, symbols, expressions, tolerance):
    import heyoka
    n, recorder = len(state), _Recorder()
    variables, everything = _heyoka_form(state, symbols, expressions)
    events = [heyoka.nt_event(e, _Note(i, recorder, n)) for i, e in enumerate(everything[n:])
              if expressions[n + i].free_symbols & set(state)]
    integrator = heyoka.taylor_adaptive(list(zip(variables, everything[:n])), [0.0] * n, tol=tolerance, nt_events=events)
    return integrator, recorder
