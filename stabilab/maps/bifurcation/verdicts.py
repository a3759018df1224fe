"""The stability of an equilibrium of a diagram, from the signs of m and n in balls and the reasons of the room `equilibrium`."""
from __future__ import annotations

from fractions import Fraction
from typing import TYPE_CHECKING, Any

from ...equilibrium.conics import WELL
from ...equilibrium.spectrum import invariants
from ...equilibrium.stability import POSITIVE_EIGENVALUE, isolated_verdict, linear_word
from ...numbers.balls import Unclear, rational, sign
from ...physics.quadratic import QuadraticForm, euler_form
from .eliminated import Eliminated, Leant, Root, evaluated
from .family import Family
from .result import State
from .system import BORDERS, ISOLATED

if TYPE_CHECKING:
    from flint import arb

BORDER = ("border", "m = 0 on the curve of equilibria: stability changes here")
SMALL = 1e-17  # radius of a ball over one plus its size
CROSSES = ("undecided", "the curve that the motion keeps to crosses itself here")


def ball_form(family: Family, values: list) -> tuple[QuadraticForm, list[arb]]:
    """(the rates with balls for coefficients, u) at values of what varies."""
    from flint import arb
    unknowns = [arb(0)] * 2
    numbers: dict[str, Any] = {name: [evaluated(c, [*unknowns, *values]) for c in row] for name, row in family.numbers.items()}
    if not family.scaled:
        return euler_form(tuple(numbers["D"]), tuple(numbers["lam"]), tuple(numbers["M"])), numbers["u"]
    half, l1 = numbers["u"][0] / 2, numbers["lam"][0]
    one: Any = arb(1)
    zero: Any = arb(0)
    return QuadraticForm((one, -one, one), (zero, zero, half + l1), (zero, l1 - half, zero), tuple(numbers["M"]), "x"), numbers["u"]


def state_of(family: Family, y: tuple[arb, ...], u: list[arb]) -> tuple[arb, ...]:
    """The state in the case's variables."""
    return ((y[0] - u[0]) / 2, y[1], -y[2]) if family.scaled else tuple(y)


def doubles(x: tuple[arb, ...]) -> tuple[float, ...]:
    """The middles of balls that are narrow enough for doubles. Unclear where they are not."""
    if any(v.rad() > SMALL * (1 + abs(v.mid())) for v in x):
        raise Unclear
    return tuple(0.0 if v.contains(0) else float(v.mid()) for v in x)


def judged_state(family: Family, kind: str, values: list, root: Root, after: int = 0, flat: bool = False) -> State:
    """An equilibrium with its verdict. after: where branches meet in it on a motion's curve, the sign of m on the branch that goes on; flat: m is known to
    be zero there, which no ball tells. Unclear where the balls leave a sign open."""
    form, u = ball_form(family, values)
    x = state_of(family, root.y, u)
    at = doubles(x)
    if kind == BORDERS:
        return State(at, root.times, "degenerate", *BORDER)
    m, n = invariants(form, x)
    if kind == ISOLATED:
        n_sign = sign(n) if root.times == 1 else 0
        m_sign = 0 if flat or (n_sign and m.contains(0)) else sign(m)
        return State(at, root.times, linear_word(m_sign, n_sign), *isolated_verdict(m_sign, n_sign))
    if root.times == 1:
        m_sign = sign(m)
        return State(at, 1, linear_word(m_sign, 0), *(WELL.positive if m_sign > 0 else POSITIVE_EIGENVALUE))
    verdict = WELL.odd if root.times % 2 == 0 else WELL.minimum if after > 0 else WELL.maximum if after < 0 else CROSSES
    return State(at, root.times, "degenerate", *verdict)


def general_states(family: Family, kind: str, eliminated: Eliminated, value: Fraction, digits: Any, view: Leant | None = None) -> tuple[State, ...]:
    """The equilibria at a value where no branches meet, with their verdicts; asked by `settled`. view: another one than the main view."""
    return tuple(judged_state(family, kind, [rational(value)], root) for root in eliminated.at_general((value,), view))
