"""From symbols to heyoka: the gate to its Taylor series and event searches."""
from __future__ import annotations

import copy
from collections.abc import Iterable, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from functools import lru_cache, reduce
from operator import mul
from threading import RLock
from typing import TYPE_CHECKING, Any

import numpy as np

from ..physics.equations import Equations
from ..physics.to_numpy import Form, Structure, equations_of, extent, form

if TYPE_CHECKING:
    from sympy import Expr

# Default tolerance of the Taylor series: half an ulp of 1. In a spin-up the phase grows as t^2, so a relative
# 1e-12 per step would cost 2e-5 at t = 1000; a tighter step costs a few per cent.
TAYLOR_TOLERANCE = 2.0**-53
# Quadratures ride along scaled by this power of two (exact), too small ever to steer the step size.
FEATHER = 2.0**-300


def heyoka_available() -> bool:
    """Whether the Taylor integrator is installed (Linux wheels only); SciPy stands in where it is not."""
    try:
        heyoka()
    except ImportError:
        return False
    return True


def heyoka():
    """The package. It logs to stdout, among the answers, so it is left no message: of a cache on disk without
    a home, of a step that fails."""
    import heyoka
    heyoka.set_logger_level_critical()
    return heyoka


def to_taylor(equations: Equations, quadratures=(), tolerance: float = TAYLOR_TOLERANCE):
    """A heyoka integrator at t = 0 whose state is the scene's, followed by FEATHER times one integral per
    quadrature.

    quadratures: SymPy expressions of the state, integrated alongside without steering the step. Raises
    ImportError where heyoka is not installed (ask `heyoka_available` first).
    """
    equations = equations_of(equations)
    everything = form(equations, (*equations.rhs, *quadratures))
    integrator = copy.copy(_integrator(everything.structure, tolerance))
    integrator.pars[:] = everything.numbers
    return integrator


def borrowed_taylor(forms: Form, tolerance: float = TAYLOR_TOLERANCE, lanes: int = 0) -> _Borrowed:
    """Context giving an integrator as `to_taylor` makes them, which goes back for the next user: copying one
    takes longer than some hundred steps. Its time and state are those of its last user: set them.

    forms: `form(equations, (*rhs, *quadratures))`. lanes: 0, or how many motions step together (state, pars
    and the rest are then (..., lanes)). An integrator whose user failed is not handed on.
    """
    return _Borrowed(forms, tolerance, lanes)

MOST_FREE = 8


class _Borrowed:
    """A context by itself: one made of a generator costs a short run a hundredth of its time."""

    def __init__(self, forms: Form, tolerance: float, lanes: int):
        self.key = forms.structure, tolerance, lanes
        self.numbers = np.reshape(forms.numbers, (-1, 1)) if lanes else forms.numbers

    def __enter__(self):
        self.free = _free(*self.key)
        try:
            self.integrator = self.free.pop()  # one operation: safe among threads
        except IndexError:
            self.integrator = copy.copy(_integrator(*self.key))
        self.integrator.pars[:] = self.numbers
        return self.integrator

    def __exit__(self, failed, *_):
        if failed is None and len(self.free) < MOST_FREE:
            self.free.append(self.integrator)


@lru_cache(maxsize=64)
def _free(structure: Structure, tolerance: float, lanes: int) -> list:
    """The integrators of this kind that nobody uses."""
    return []


@contextmanager
def taylor_events(event_forms: Form, tolerance: float = TAYLOR_TOLERANCE):
    """Context giving (integrator, found): a heyoka integrator that notes every root of every event it passes.

    event_forms: `form(equations, (*rhs, *events))`, the rates first. found: list of (time, index of event,
    state), emptied at the start. The integrator is shared within the process and held by a lock: set its time
    and state.
    """
    with _LOCK:
        integrator, recorder = _event_integrator(event_forms.structure, tolerance)
        # constant events, which are left out, may hold the last
        integrator.pars[:] = event_forms.numbers[:len(integrator.pars)]
        recorder.found.clear()
        yield integrator, recorder.found

_LOCK = RLock()


class _Recorder:
    def __init__(self):
        self.found = []

    # heyoka copies its callbacks; the list must stay the same one
    def __deepcopy__(self, memo: Mapping[int, Any]):
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


def heyoka_form(state: Sequence[Expr], symbols: Sequence[Expr], expressions: Sequence[Expr]):
    variables = heyoka().make_vars(*map(str, state))
    swap = dict(zip(state, variables)) | {s: heyoka().par[i] for i, s in enumerate(symbols)}
    return variables, [_from_sympy(nested(e, state), swap) for e in expressions]


def nested(expression: Expr, state: Sequence[Expr]):
    """A polynomial of the state as x (terms that held x, without it) + y (others that held y) + ...: each
    product of two series costs as much as ten of a series and a number. As it is where that saves none, and
    where it is no polynomial."""
    from sympy import Add
    terms = [_powers(term, state) for term in Add.make_args(expression)]
    if None in terms:
        return expression
    held = [(coefficient, powers) for coefficient, powers in terms if sum(powers.values()) > 1]
    rest = [_monomial(*term) for term in terms if term not in held]
    before = sum(sum(powers.values()) - 1 for _, powers in held)
    after = 0
    while held:
        head = max(state, key=lambda x: sum(x in powers for _, powers in held))
        inner = [(coefficient, powers | {head: powers[head] - 1}) for coefficient, powers in held
                 if head in powers]
        held = [(coefficient, powers) for coefficient, powers in held if head not in powers]
        after += 1 + sum(max(sum(powers.values()) - 1, 0) for _, powers in inner)
        rest.append(head * Add(*(_monomial(*term) for term in inner)))
    return Add(*rest) if after < before else expression


def _powers(term: Expr, state: Sequence[Expr]) -> tuple[Expr, dict[Expr, int]] | None:
    """(coefficient, powers of the state) of a monomial; None of what is none."""
    coefficient, powers = [], {}
    for base, exponent in (factor.as_base_exp() for factor in term.as_ordered_factors()):
        if base in state and exponent.is_Integer and exponent > 0:
            powers[base] = int(exponent)
        elif not base.free_symbols.isdisjoint(state):
            return None
        else:
            coefficient.append(base**exponent)
    return reduce(mul, coefficient, term * 0 + 1), powers


def _monomial(coefficient: Expr, powers: Mapping[Expr, int]):
    return reduce(mul, (x**n for x, n in powers.items()), coefficient)


def _from_sympy(expression: Expr, swap: dict[Expr, Any]):
    """heyoka.from_sympy turns away ratios and lone numbers; `form` has left only integers and symbols. Its
    series of a power divides by the base, which may be zero, but for squares: powers are products."""
    from sympy import Dummy, Pow
    if expression.is_number:
        return heyoka().expression(float(expression))
    high = {atom: Dummy() for atom in expression.atoms(Pow) if atom.exp.is_Integer and atom.exp > 2}
    products = {name: reduce(mul, [_from_sympy(key.base, swap)] * int(key.exp)) for key, name in high.items()}
    return heyoka().from_sympy(expression.xreplace(high), swap | products)


LARGE = 500  # different subexpressions, from which on straight code takes ten seconds and more to compile


def in_loops(expressions: Iterable[Expr]) -> bool:
    """Whether heyoka is to compile the series in loops (its compact mode), not as straight code: of many
    operations that takes under a second in place of a minute, and the steps are as fast."""
    return extent(expressions)[1] > LARGE


@lru_cache(maxsize=64)
def _integrator(structure: Structure, tolerance: float, lanes: int = 0):
    n, count = len(structure.state), len(structure.expressions)
    variables, rates = heyoka_form(structure.state, structure.symbols, structure.expressions)
    extra = heyoka().make_vars(*(f"quadrature{i}" for i in range(count - n))) if count > n else []
    extra = extra if isinstance(extra, list) else [extra]
    rates[n:] = [FEATHER * r for r in rates[n:]]
    make, shape = (heyoka().taylor_adaptive_batch, (lanes,)) if lanes else (heyoka().taylor_adaptive, ())
    return make(list(zip([*variables, *extra], rates)), np.zeros((count, *shape)),
                pars=np.zeros((len(structure.symbols), *shape)), tol=tolerance,
                compact_mode=in_loops(structure.expressions))


@contextmanager
def compiled_anew():
    """Integrators made inside are compiled, as on a computer that has not made them before: to measure it."""
    _integrator.cache_clear()
    _event_integrator.cache_clear()
    cache = heyoka().llvm_state
    cache.clear_memcache()
    enabled = cache.get_diskcache_enabled()
    cache.set_diskcache_enabled(False)
    try:
        yield
    finally:
        cache.set_diskcache_enabled(enabled)


@lru_cache(maxsize=64)
def _event_integrator(structure: Structure, tolerance: float):
    n, recorder = len(structure.state), _Recorder()
    variables, everything = heyoka_form(structure.state, structure.symbols, structure.expressions)
    events = [heyoka().nt_event(e, _Note(i, recorder, n)) for i, e in enumerate(everything[n:])
              if structure.expressions[n + i].free_symbols & set(structure.state)]
    integrator = heyoka().taylor_adaptive(list(zip(variables, everything[:n])), [0.0] * n, tol=tolerance,
                                          nt_events=events, compact_mode=in_loops(structure.expressions))
    return integrator, recorder
