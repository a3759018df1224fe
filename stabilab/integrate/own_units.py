"""The equations of a motion in its own units of rates and of time.

The step control of Taylor series is relative to the state above size 1 but absolute below, and the
coefficients of a series underflow or overflow where the unit of time is far from the pace of the motion. The
two are not the same: a body that a strong damper slows has a short time and small rates, a sphere that turns
fast in a thin medium a long time and large ones. With omega = u y and t = s/v, y' = f(u y)/(u v). For u and v
powers of two the change is exact.
"""
from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import lru_cache
from operator import itemgetter

import numpy as np

from ..errors import InputError
from ..physics.equations import Equations, Symbolic
from ..physics.own_unit import FAST, HEAVY, LIGHT, SLOW, exponent
from ..physics.scene import BLOCKS
from ..physics.to_numpy import to_numpy

RATES = {"omega", "damper", "damper_wheel"}  # blocks of rates, rad/s
PLAIN = {"gamma", "attitude"}  # blocks of size 1
# beside a block of size 1 slow rates are followed to 1e-16 of 1: a unit of their own from here on
SLOW_BESIDE = 2.0**-20
# a pace so many times as fast, or as slow, as the rates has a unit of its own; looked at where the change in
# a unit of time is so many times the rates, or so small a part of them
APART, UNLIKE = 2.0**6, 2.0**12
SMALLEST, LARGEST = 2.0**-1000, 2.0**1000


@dataclass(frozen=True)
class Units:
    """Powers of two: rates over `rate`, times over 1/`pace`, laws each over a unit of its own if `laws`."""

    rate: float = 1.0
    pace: float = 1.0
    laws: bool = False

    @property
    def plain(self) -> bool:
        return self.rate == self.pace == 1 and not self.laws

    def times(self, times: np.ndarray | float) -> np.ndarray:
        """Times in the own unit. Raises InputError where these are no doubles."""
        if self.pace == 1:
            return np.asarray(times)
        with np.errstate(all="ignore"):
            own = np.asarray(times) * self.pace
        if not np.isfinite(own).all():
            raise InputError(f"times: {float(np.abs(times).max()):.3g} is too far for a motion that changes "
                             f"at a pace of {self.pace:.1e}: no run in doubles follows it")
        return own


_PLAIN, _WITH_LAWS = Units(), Units(laws=True)


def units_of(equations: Equations, state: np.ndarray) -> Units:
    """The units of the motion from a state (n,), 1 where its rates are ordinary."""
    now, quick, size = _sizes_of_one(equations, state)
    laws = _heavy_or_light(equations)
    if not 0 < size < math.inf or _ordinary(equations, now, quick, size):
        return _WITH_LAWS if laws else _PLAIN
    pace = pace_of(equations, state)
    if 0 < pace < math.inf and not 1 / APART <= pace / size <= APART:
        return _power(max(now, quick / pace), pace, True)
    return Units(laws=laws) if _slow(equations) <= size <= 2.0**FAST else _power(size, size, True)


def are_ordinary(equations: Equations, now: np.ndarray, quick: np.ndarray, size: np.ndarray) -> np.ndarray:
    """(m,) which motions are followed in units of 1, at a glance at the sizes of their rates, `sizes_of`."""
    if not _has_units(equations):
        return np.ones(len(size), bool)
    with np.errstate(all="ignore"):
        fraction = quick / np.where(now > 0, now, size)
    similar = (quick == 0) | ((fraction >= 1 / UNLIKE) & (fraction <= UNLIKE))
    return (size >= _slow(equations)) & (size <= 2.0**FAST) & similar


def _ordinary(equations: Equations, now: float, quick: float, size: float) -> bool:
    """`are_ordinary` of one motion, by the sizes of its rates; size is neither 0 nor infinite."""
    if not _has_units(equations):
        return True
    similar = quick == 0 or 1 / UNLIKE <= quick / (now if now > 0 else size) <= UNLIKE
    return _slow(equations) <= size <= 2.0**FAST and similar


def _sizes_of_one(equations: Equations, state: np.ndarray) -> tuple[float, float, float]:
    """`sizes_of` one state (n,): a glance by plain floats, which cost a short run less than arrays; these
    where a number leaves their range, which floats refuse."""
    turning, rates = _turning_of_row(equations), state.tolist()
    try:
        changes = to_numpy(equations).rate(rates)
        now, quick = max(map(abs, turning(rates))), max(map(abs, turning(changes)))
        if math.isfinite(sum(changes)):
            return now, quick, max(now, math.sqrt(quick))
    except ArithmeticError:
        pass
    now, quick, size = (float(column[0]) for column in sizes_of(equations, state[None]))
    return now, quick, size


@lru_cache(maxsize=64)
def _heavy_or_light(equations: Equations) -> bool:
    """Whether a moment is so large or small that the laws need units of their own."""
    return any(not LIGHT <= value <= HEAVY
               for name, value in equations.parameters.items() if name in ("D1", "D2", "D3"))


@lru_cache(maxsize=64)
def _turning_indices(equations: Equations) -> list[int]:
    """Which components of the state are rates."""
    return np.nonzero(_turning(equations))[0].tolist()


@lru_cache(maxsize=64)
def _turning_of_row(equations: Equations) -> Callable[[list[float]], tuple[float, ...]]:
    """What picks the rates, three at least, from a state."""
    return itemgetter(*_turning_indices(equations))


def sizes_of(equations: Equations, states: np.ndarray, changes: np.ndarray | None = None
             ) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """(m,) the largest rate of states (m, n), its largest change, and the size of the rates: theirs, or what
    the change makes of it, its root. changes: of the states (m, n), where they are known already."""
    turning = _turning_indices(equations)
    with np.errstate(all="ignore"):
        changes = to_numpy(equations)(states) if changes is None else changes
        # column by column: along rows of three NumPy takes ten times as long
        now, quick = (np.abs(rows.T[turning]).max(axis=0) for rows in (states, changes))
        return now, quick, np.maximum(now, np.sqrt(quick))


@lru_cache(maxsize=64)
def _has_units(equations: Equations) -> bool:
    """Whether all of the state are rates, which may have a unit of their own, or of size 1."""
    return set(equations.blocks) <= RATES | PLAIN


@lru_cache(maxsize=64)
def _slow(equations: Equations) -> float:
    return SLOW_BESIDE if set(equations.blocks) & PLAIN else 2.0**SLOW


def _power(size: float, pace: float, laws: bool) -> Units:
    size, pace = (min(max(v, SMALLEST), LARGEST) for v in (size, pace))
    return Units(2.0 ** exponent(size), 2.0 ** exponent(pace), laws)


def pace_of(equations: Equations, state: np.ndarray) -> float:
    """How fast the motion may change at a state, 1/s: the largest derivative of the rates, and the root of
    what their changes make of it in a unit of time."""
    system, turning = to_numpy(equations), _turning(equations)
    with np.errstate(all="ignore"):
        there, gradient = np.array(system.rate(state.tolist()), float), system.jacobian(state)
        along = system.jacobian(there) - system.jacobian(np.zeros(state.size))
        across = np.abs(gradient[np.ix_(turning, ~turning)]).max(initial=0.0)
        return float(max(np.abs(gradient[np.ix_(turning, turning)]).max(), math.sqrt(across),
                         np.abs(gradient[np.ix_(~turning, ~turning)]).max(initial=0.0),
                         math.sqrt(np.abs(along[np.ix_(turning, turning)]).max())))


def _turning(equations: Equations) -> np.ndarray:
    """(n,) which components of the state are rates."""
    return np.array([name in RATES for name in equations.blocks for _ in BLOCKS[name].components])


def scale_of(equations: Equations, units: Units) -> np.ndarray:
    """(n,) the unit of each component of the state."""
    return np.where(_turning(equations), units.rate, 1.0)


def in_units(equations: Equations, units: Units) -> Equations:
    """The equations of y(s), with the laws over their own units."""
    return equations if units.plain else _in_units(equations, units)


@lru_cache(maxsize=32)  # what is made of equations is kept by identity
def _in_units(equations: Equations, units: Units) -> Equations:
    from sympy import Integer, Symbol
    parameters, symbols = dict(equations.parameters), dict(equations.symbols)

    def named(name: str, value: float | Fraction) -> Symbolic:
        parameters[name], symbols[name] = Fraction(value), Symbol(name, real=True)
        return symbols[name]

    rate = named("unit_of_rates", units.rate)
    pace = rate if units.pace == units.rate else named("pace", units.pace)
    factors = [rate if turns else Integer(1) for turns in _turning(equations)]
    put = {x: factor * x for x, factor in zip(equations.state, factors)}
    rhs: tuple[Symbolic, ...] = tuple(item.xreplace(put) / (factor * pace)
                                      for item, factor in zip(equations.rhs, factors))
    built = replace(equations, parameters=parameters, symbols=symbols, rhs=rhs, balances=())
    laws = []
    for law in equations.balances:
        quantity, change = law.quantity.xreplace(put), law.rate.xreplace(put) / pace
        size = named(f"unit_of_{len(laws)}", _size(built, quantity))
        laws.append(replace(law, quantity=quantity / size, rate=change / size))
    return replace(built, parameters=parameters, symbols=symbols, balances=tuple(laws))


def _size(equations: Equations, quantity: Symbolic) -> Fraction:
    """The power of two near the largest coefficient of a law's quantity; 1 where it is no polynomial of the
    state."""
    from sympy import Poly, PolynomialError
    try:
        terms = Poly(equations.numeric(quantity), *equations.state).terms()
    except PolynomialError:
        return Fraction(1)
    sizes = [abs(Fraction(int(c.p), int(c.q))) for powers, c in terms if any(powers) and c.is_Rational]
    largest = max(sizes, default=Fraction(0)) or Fraction(1)
    return Fraction(2) ** exponent(largest)
