"""The scenes over a range as polynomials, and what is found over it: a diagram as data.

Moments, wheel, torque and start are polynomials with exact coefficients in the numbers that vary.
The case is read at rational values of its numbers; polynomials through these that hold at further values as
well are the law by which the numbers enter. Torques, momenta, moments, forces, arms and speeds enter so; a
direction or a product of inertia turns axes, by roots, and is refused.
"""
from __future__ import annotations

from dataclasses import dataclass, field
from fractions import Fraction
from functools import cached_property
from itertools import product
from math import prod
from typing import Any

from flint import fmpq_mat, fmpq_mpoly, fmpq_mpoly_ctx

from ...case.read import Case, with_data
from ...equilibrium.stability import pencil
from ...errors import InputError, printable
from ...numbers.balls import rational
from ...numbers.vectors import Float3
from ...physics.coefficients import effective
from ...representation import Shown
from ..axes import Span, with_values

DEGREE = 3  # in each number that varies; a thruster's arm, force and a wheel's speed come to one each
CHECKS = 2  # further values at which the polynomials must hold
VARIABLES = ("x", "y", "p", "q")  # two unknowns of an elimination, then the numbers that vary


@dataclass(frozen=True)
class Family:
    """case: as the file has it; data: its TOML data; spans: what varies."""

    case: Case
    data: dict[str, Any] = field(repr=False)
    spans: tuple[Span, ...]

    def at(self, values: tuple[Fraction, ...]) -> Case:
        """The case with these values, exactly. Raises InputError where they make none."""
        written = [(span.key, span.written(value)) for span, value in zip(self.spans, values)]
        return with_data(self.case.path, self.case.text, with_values(self.data, written))

    @cached_property
    def ring(self) -> fmpq_mpoly_ctx:
        """Polynomials in two unknowns and the numbers that vary."""
        return fmpq_mpoly_ctx.get(VARIABLES, "lex")

    @cached_property
    def numbers(self) -> dict[str, tuple[fmpq_mpoly, ...]]:
        """D, lam, M, u (of `Pencil`) and y, the start in its variables (absent without a motion), as
        polynomials."""
        grids = [[span.low + (span.high - span.low) * Fraction(n, DEGREE) for n in range(DEGREE + 1)]
                 for span in self.spans]
        table = {values: _numbers_of(self._read(values)) for values in product(*grids)}
        rows, exponents = list(table.values()), list(product(range(DEGREE + 1), repeat=len(self.spans)))
        places = [(name, n) for name in rows[0] for n in range(3)]
        monomial = lambda values, powers: prod(rational(v) ** e for v, e in zip(values, powers))
        left = fmpq_mat([[monomial(values, powers) for powers in exponents] for values in table])
        solved = left.solve(fmpq_mat([[rational(row[name][n]) for name, n in places] for row in rows]))
        columns = zip(*solved.tolist())
        terms = [(0, 0, *powers, 0)[:len(VARIABLES)] for powers in exponents]
        law = lambda column: self.ring.from_dict({powers: c for powers, c in zip(terms, column) if c != 0})
        laws = [law(column) for column in columns]
        found = {name: tuple(laws[n:n + 3]) for n, (name, place) in enumerate(places) if not place}
        for number in range(1, CHECKS + 1):
            values = tuple(span.low + (span.high - span.low) * Fraction(2 * number - 1 + k, 7 + 4 * k)
                           for k, span in enumerate(self.spans))
            self._hold(found, values)
        return found

    @property
    def scaled(self) -> bool:
        """Whether the case is in dimensionless variables."""
        return self.case.variables == "scaled"

    def _read(self, values: tuple[Fraction, ...]) -> Case:
        try:
            return self.at(values)
        except InputError as error:
            told = ", ".join(f"{span.label} = {float(value):.6g}" for span, value in zip(self.spans, values))
            first = str(error).splitlines()[0]
            raise InputError(f"vary: the range leaves what a case may be: at {told}: {first}") from None

    def _hold(self, found, values) -> None:
        """Refuse a range over which the polynomials are not the numbers of the case at further values."""
        case = self._read(values)
        put_in = dict(zip(("p", "q"), map(rational, values)))
        for name, row in _numbers_of(case).items():
            for polynomial, value in zip(found[name], row):
                if polynomial.subs(put_in) != rational(value):
                    keys = " and ".join(printable(span.key.name) for span in self.spans)
                    what = {"D": "principal moments", "lam": "wheel", "M": "torque", "u": "wheel",
                            "y": "start"}[name]
                    raise InputError(f"vary {keys}: the {what} of the case (along principal axes, in its "
                                     f"variables) is no polynomial of it of degree {DEGREE}, so nothing can "
                                     "be eliminated exactly: vary a moment of inertia, a torque, a force or "
                                     "a wheel instead, or use stabilab sweep")


def _numbers_of(case: Case) -> dict[str, tuple[Fraction, ...]]:
    p = pencil(effective(case.scene))
    start = case.exact_state
    found = {"D": p.D, "lam": p.lam, "M": p.M, "u": p.u}
    return found | ({"y": tuple(a * x + u for a, x, u in zip(p.A, start, p.u))} if start is not None else {})


CURVES = "curves"  # the kind of a diagram in words
ENDLESS = -1  # in the place of a count: equilibria without number, curves of them


@dataclass(frozen=True)
class State:
    """An equilibrium: at in the case's variables along the principal axes; times: how many branches meet in
    it; linear, verdict, because: as those of `equilibrium.result.EquilibriumPoint`."""

    at: Float3
    times: int
    linear: str
    verdict: str
    because: str


@dataclass(frozen=True)
class Event:
    """A value at which something happens. value: a double, in the unit of the range; exact: the number itself
    where it is rational; polynomial: whole coefficients, lowest power first, of which it is the real root
    number `index` (in rising order, from 0); kinds: "fold", "pitchfork", "crossing", "touch", "infinity",
    "axis", "curve" or "connection", as `words` tells; count: equilibria there, ENDLESS for curves of them;
    states: those there."""

    value: float
    exact: Fraction | None
    polynomial: tuple[int, ...]
    index: int
    kinds: tuple[str, ...]
    count: int
    states: tuple[State, ...]
    words: str


@dataclass(frozen=True)
class Piece:
    """An open piece of the range with one number of equilibria. low, high: doubles; sample: a value inside,
    exact; states: the equilibria there, in the order in which their branches are numbered; seams: values
    inside at which two of them may change places in the component that orders them; words: which curves there
    are, where equilibria form these."""

    low: float
    high: float
    count: int
    sample: Fraction
    states: tuple[State, ...]
    seams: tuple[float, ...] = ()
    words: str = ""


@dataclass(frozen=True, repr=False)
class Diagram(Shown):
    """All equilibria over one number. kind: which are counted ("isolated", "motion", "borders" or "curves");
    what: the same in words; pieces and events in rising order: event n lies between pieces; an event at an
    end of the range has a piece on one side only."""

    family: Family = field(repr=False)
    kind: str
    what: str
    pieces: tuple[Piece, ...]
    events: tuple[Event, ...]
    connections: tuple[Event, ...] = ()
    notes: tuple[str, ...] = ()
