"""Time constants with which a small departure from the end of a motion that loses energy dies out.

They are -1/Re of the eigenvalues of the equations linearised at the end, the Jacobian from the equations in
symbols, its eigenvalues in many digits: the real part of a nutation is often 1e-9 of its rate. Where eddy
currents bring a body to rest its attitude there is open; near it the rate about axis i across the field falls
with D_i/(k B^2)."""
from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

from ...numbers.vectors import Number
from ...physics.coefficients import Content
from ...physics.equations import derive, values
from ...physics.scene import AnyScene

DIGITS = 60  # of eigenvalues: those of exact states that are zero come out far below the share that counts
ZERO_OF_EXACT, ZERO_OF_RUN = 1e-25, 1e-9  # of the largest eigenvalue: one that is zero


@dataclass(frozen=True)
class TimeConstant:
    """time: s, in which a departure falls to 1/e; turns: rad/s, at which it turns meanwhile, 0 where it only
    falls; axis: 1 to 3, of the rotation that falls, 0 where it is a departure of more than one."""

    time: float
    turns: float = 0.0
    axis: int = 0


def time_constants(scene: AnyScene, state: Sequence[Number], exact: bool = True) -> tuple[TimeConstant, ...]:
    """Those of the departures from a state (N,) at which the rates stay, the longest first; a pair of
    eigenvalues gives one. exact: whether the state is exact, or a run's, good to 1e-9 or so."""
    from mpmath import mp, workdps
    from sympy import Rational
    equations = derive(scene)
    rational = lambda v: Rational(*Fraction(v).as_integer_ratio())
    numbers = dict(zip(equations.state, map(rational, state))) | values(equations)
    with workdps(DIGITS):
        matrix = mp.matrix([[mp.mpf(e.p) / e.q for e in row]
                            for row in equations.jacobian.xreplace(numbers).tolist()])
        found = mp.eig(matrix, left=False, right=False)
        zero = max(map(abs, found)) * (ZERO_OF_EXACT if exact else ZERO_OF_RUN)
        falling = [z for z in found if z.real < -zero and z.imag > -zero]
        return _ordered(TimeConstant(float(-1 / z.real), float(z.imag) if z.imag > zero else 0.0)
                        for z in falling)


def near_rest_across(parts: Content) -> tuple[TimeConstant, ...]:
    """Those of rotations about the axes across the field, near rest, under eddy currents alone."""
    return _ordered(TimeConstant(float(d / parts.eddy), axis=n) for n, d in enumerate(parts.D, 1))


def _ordered(items: Iterable[Any]) -> tuple[TimeConstant, ...]:
    return tuple(sorted(items, key=lambda item: (-item.time, item.turns, item.axis)))
