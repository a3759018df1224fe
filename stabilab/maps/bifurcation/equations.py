"""Scenes over a range as polynomials, the equations whose real zeros a diagram counts, and the diagram as
data.

Moments, wheel, torque and start are polynomials with exact coefficients in the numbers that vary.
The case is read at rational values of its numbers; polynomials through these that hold at further values as
well are the law by which the numbers enter. Torques, momenta, moments, forces, arms and speeds enter so; a
direction or a product of inertia turns axes, by roots, and is refused.

The equations have one or two unknowns, with polynomial coefficients in the numbers that vary.

Off the principal axes they are isolated: on the line where the two linear conditions meet, y = (P + x v)/w,
one quadratic remains (`equilibrium.gyrostat`). A torque on principal axis i, with no wheel along it, has a
whole conic of them, and a motion stays on its own curve across that axis, W = const: the equilibria on this
curve are where two conics meet. Without a motion the points of the conic where stability changes are counted,
m = 0, another two conics. All unknowns are components of y (`equilibrium.stability.Pencil`)."""
from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from functools import cached_property, reduce
from itertools import product
from math import prod
from typing import Any

from flint import fmpq_mat, fmpq_mpoly, fmpq_mpoly_ctx

from ...answers.caveats import of_case
from ...case.read import Case, with_data
from ...equilibrium.stability import pencil
from ...errors import Caveat, InputError, printable
from ...numbers.balls import rational
from ...numbers.vectors import CYCLE, Float3, cross, dot
from ...physics.coefficients import effective
from ...reasons import Axis, Reason, Reasoned, Sentence
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
        entries = {name: tuple(laws[n:n + 3]) for n, (name, location) in enumerate(places) if not location}
        for number in range(1, CHECKS + 1):
            values = tuple(span.low + (span.high - span.low) * Fraction(2 * number - 1 + k, 7 + 4 * k)
                           for k, span in enumerate(self.spans))
            self._hold(entries, values)
        return entries

    @property
    def scaled(self) -> bool:
        """Whether the case is in dimensionless variables."""
        return self.case.variables == "scaled"

    def _read(self, values: tuple[Fraction, ...]) -> Case:
        try:
            return self.at(values)
        except InputError as error:
            text = ", ".join(f"{span.label} = {float(value):.6g}" for span, value in zip(self.spans, values))
            first = str(error).splitlines()[0]
            raise InputError(f"vary: the range leaves what a case may be: at {text}: {first}") from None

    def _hold(self, result, values) -> None:
        """Refuse a range over which the polynomials are not the numbers of the case at further values."""
        case = self._read(values)
        put_in = dict(zip(("p", "q"), map(rational, values)))
        for name, row in _numbers_of(case).items():
            for polynomial, value in zip(result[name], row):
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
    result = {"D": p.D, "lam": p.lam, "M": p.M, "u": p.u}
    return result | ({"y": tuple(a * x + u for a, x, u in zip(p.A, start, p.u))} if start is not None else {})


CURVES = "curves"  # the kind of a diagram in words
ENDLESS = -1  # in the place of a count: equilibria without number, curves of them


@dataclass(frozen=True)
class State(Reasoned):
    """An equilibrium: at in the case's variables along the principal axes; times: how many branches meet in
    it; linear, verdict, reason: as those of `equilibrium.result.EquilibriumPoint`."""

    at: Float3
    times: int
    linear: str
    verdict: str


@dataclass(frozen=True)
class Event(Reasoned):
    """A value at which something happens. value: a double, in the unit of the range; exact: the number itself
    where it is rational; polynomial: whole coefficients, lowest power first, of which it is the real root
    number `index` (in rising order, from 0); kinds: "fold", "pitchfork", "crossing", "touch", "infinity",
    "axis", "curve" or "connection", as `reason` tells, `words` in words; count: equilibria there, ENDLESS for
    curves of them; states: those there."""

    value: float
    exact: Fraction | None
    polynomial: tuple[int, ...]
    index: int
    kinds: tuple[str, ...]
    count: int
    states: tuple[State, ...]

    @property
    def words(self) -> str:
        """What happens, in words."""
        return self.reason.text()


@dataclass(frozen=True)
class Piece:
    """An open piece of the range with one number of equilibria. low, high: doubles; sample: a value inside,
    exact; states: the equilibria there, in the order in which their branches are numbered; seams: values
    inside at which two of them may change places in the component that orders them; reason: which curves
    there are, where equilibria form these, else None; words: the same in words."""

    low: float
    high: float
    count: int
    sample: Fraction
    states: tuple[State, ...]
    seams: tuple[float, ...] = ()
    reason: Reason | None = None

    @property
    def words(self) -> str:
        """Which curves there are, in words; empty where equilibria form none."""
        return "" if self.reason is None else self.reason.text()


class Counted(Shown):
    """What a map of equilibria says of itself in words, over one number or over two."""

    family: Family
    counted: Reason
    remarks: tuple[Reason, ...]

    @property
    def caveats(self) -> tuple[Caveat, ...]:
        """All that limits it: the caveats of its case."""
        return of_case(self.family.case)

    @property
    def what(self) -> str:
        """Which equilibria are counted, in words."""
        return self.counted.text()

    @property
    def notes(self) -> tuple[str, ...]:
        """What else there is to say, in words."""
        return tuple(map(str, self.remarks))


@dataclass(frozen=True, repr=False)
class Diagram(Counted):
    """All equilibria over one number. kind: which are counted ("isolated", "motion", "borders" or "curves");
    counted: the same as a sentence, what: in words; pieces and events in rising order: event n lies between
    pieces; an event at an end of the range has a piece on one side only. remarks: what else there is to say,
    notes: the same in words."""

    family: Family = field(repr=False)
    kind: str
    counted: Reason
    pieces: tuple[Piece, ...]
    events: tuple[Event, ...]
    connections: tuple[Event, ...] = ()
    remarks: tuple[Reason, ...] = ()


ISOLATED, LEAF, BORDERS = "isolated", "motion", "borders"
# X = x - lean y
LEANS = tuple(Fraction(*parts) for parts in ((0, 1), (1, 1), (-1, 1), (2, 1), (1, 2), (-3, 1), (1, 3), (3, 1),
                                             (-2, 1), (5, 2)))


@dataclass(frozen=True)
class OnLine:
    """One quadratic c[0] + c[1] x + c[2] x^2 = 0 on the line y = (start + x along)/below. special: zero where
    the torque falls on a principal axis."""

    coefficients: tuple[fmpq_mpoly, ...]
    start: tuple[fmpq_mpoly, ...]
    along: tuple[fmpq_mpoly, ...]
    below: fmpq_mpoly
    special: fmpq_mpoly
    load: fmpq_mpoly
    kind: str = ISOLATED

    def m(self, family: Family) -> fmpq_mpoly:
        """m of z^3 + m z + n along the line, times below^2 and the positive moments: a quadratic polynomial
        of y, made homogeneous."""
        x, zero = family.ring.gens()[0], family.ring.constant(0)
        y = [s + x * a for s, a in zip(self.start, self.along)]
        there, mirrored = _linear_m(family, y), _linear_m(family, [-c for c in y])
        middle = _linear_m(family, [zero] * 3)
        mean, half = (there + mirrored) / 2, (there - mirrored) / 2
        return mean - middle + half * self.below + middle * self.below * self.below


@dataclass(frozen=True)
class Conics:
    """Two conics f = g = 0 in the components x = y_j and y = y_k of the state, the third being zero; axis: i
    of the torque. special: zero where the equations do not hold all equilibria of the kind (along a curve of
    them: where the torque vanishes)."""

    f: fmpq_mpoly
    g: fmpq_mpoly
    axis: int
    kind: str
    special: fmpq_mpoly
    load: fmpq_mpoly

    def leant(self, lean: Fraction) -> tuple[fmpq_mpoly, fmpq_mpoly]:
        """Both in X = x - lean y and y: points one above another move apart."""
        ring = self.f.context()
        x, y, p, q = ring.gens()
        moved = (x + y * rational(lean), y, p, q)
        return self.f.compose(*moved, ctx=ring), self.g.compose(*moved, ctx=ring)


def fixed_axis(family: Family) -> int | None:
    """The principal axis that carries the torque all over the range; None where there is none."""
    M = family.numbers["M"]
    along = [i for i in range(3) if not M[i].is_zero()]
    return along[0] if len(along) == 1 else None


def on_line(family: Family) -> OnLine:
    """The isolated equilibria of a torque off the principal axes; `special` is zero where none of the range
    has one."""
    n = family.numbers
    D, lam, M = n["D"], n["lam"], n["M"]
    turned = lambda v: tuple(d * c for d, c in zip(D, v))
    v = cross(M, turned(M))
    shared = common_divisor(v)
    if shared.is_zero():
        return OnLine((shared,) * 3, v, v, shared, shared, dot(lam, M))
    v = tuple(c / shared for c in v)
    load, below = dot(lam, M), shared * dot(v, v)
    start = tuple(load * c for c in cross(M, v))
    det = lambda a, b: dot(cross(a, b), M)
    Dv, H = turned(v), tuple(a + below * b for a, b in zip(turned(start), lam))
    rows = [det(H, start) + dot(M, M) * below * below, det(Dv, start) + det(H, v), det(Dv, v)]
    content = common_divisor(rows)
    if not content.is_zero():
        rows = [c / content for c in rows]
        shared *= content
    return OnLine(tuple(rows), start, v, below, shared, load)


def across(family: Family, axis: int, kind: str) -> Conics:
    """The equilibria on the curve that the motion stays on (LEAF), or where stability changes along the conic
    (BORDERS)."""
    n = family.numbers
    j, k = CYCLE[axis]
    x, y = family.ring.gens()[:2]
    D, lam, M = n["D"], n["lam"], n["M"]
    f = (D[j] * x + lam[j]) * y - (D[k] * y + lam[k]) * x + M[axis]
    if kind == LEAF:
        keeps = _kept(family, axis)
        g = keeps(x, y) - keeps(n["y"][j], n["y"][k])
    else:
        location: list[Any] = [None] * 3
        location[axis], location[j], location[k] = family.ring.constant(0), x, y
        g = _linear_m(family, location)
    item, zero = family.ring.constant(1), family.ring.constant(0)
    return Conics(f, g, axis, kind, M[axis] if kind == BORDERS else item, zero)


def _kept(family: Family, axis: int):
    """W(y_j, y_k), which every motion keeps: |H|^2 - 2 D_i T across the torque, or the scaled system's own.
    """
    n = family.numbers
    (j, k), D, lam = CYCLE[axis], n["D"], n["lam"]
    if not family.scaled:
        return lambda x, y: ((D[j] * x + lam[j]) * (D[j] * x + lam[j])
                             + (D[k] * y + lam[k]) * (D[k] * y + lam[k])
                             - D[axis] * (D[j] * x * x + D[k] * y * y))
    half = lambda y1: y1 * family.ring.constant(1) / 2  # x1 + a = y1/2 - lam1, x1 + b = y1/2 + lam1
    if axis == 2:
        return lambda y1, y2: (half(y1) - lam[0]) * (half(y1) - lam[0]) + y2 * y2
    if axis == 1:
        return lambda y3, y1: (half(y1) + lam[0]) * (half(y1) + lam[0]) - y3 * y3
    return lambda y2, y3: y2 * y2 + y3 * y3


def _linear_m(family: Family, y: Sequence[fmpq_mpoly]) -> fmpq_mpoly:
    """m of z^3 + m z + n at y, times the positive moments (all 1 in scaled variables)."""
    n, item = family.numbers, family.ring.constant(1)
    kappa: Sequence[fmpq_mpoly]
    rho: Sequence[fmpq_mpoly]
    sigma: Sequence[fmpq_mpoly]
    if family.scaled:
        u1, l1 = n["u"][0], n["lam"][0]
        a, b = u1 / 2 - l1, u1 / 2 + l1
        x = ((y[0] - u1) / 2, y[1], -y[2])
        weights, kappa = (item,) * 3, (item, -item, item)
        rho, sigma = (0 * item, 0 * item, b), (0 * item, -a, 0 * item)
    else:
        D, lam = n["D"], n["lam"]
        x, weights, kappa = (y[0], y[1], y[2]), (D[0], D[1], D[2]), tuple(D[j] - D[k] for j, k in CYCLE)
        rho, sigma = tuple(lam[j] for j, _ in CYCLE), tuple(-lam[k] for _, k in CYCLE)
    total = 0 * item
    # the pair (j, k): entries row j, column k and row k, column j of the Jacobian
    for i, (j, k) in enumerate(CYCLE):
        row_j = kappa[j] * x[i] + sigma[j]
        row_k = kappa[k] * x[i] + rho[k]
        total -= row_j * row_k * weights[i]
    return total


def common_divisor(parts: Iterable[fmpq_mpoly]) -> fmpq_mpoly:
    """The greatest one of all."""
    return reduce(lambda f, g: f.gcd(g), parts)


ARE_ISOLATED = Sentence("isolated-equilibria",
                        "isolated equilibria (torque off the principal axes)")()
ON_CURVE = Sentence("equilibria-on-curve", "equilibria on the curve that the motion stays on, all branches "
                    "of it (torque on {axis})")
STABILITY_CHANGES = Sentence("stability-changes-along-curve",
                             "points where stability changes along the curve of equilibria")()
CURVES_ALWAYS = Sentence("curves-for-every-value",
                         "without a torque equilibria form curves for every value")()
CURVES_OF_EQUAL = Sentence("curves-of-equal-moments", "the torque lies along equal moments of inertia, where "
                           "equilibria form curves")()
NO_EQUILIBRIUM = Sentence(
    "diagram-wheel-along-torque", "the torque lies on {axis} and a wheel carries momentum along it: no "
    "equilibrium wherever neither is zero")
NO_BALANCE = Sentence("nothing-balances",
                      "three equal moments of inertia and no wheel: nothing balances a torque")()
WHOLE_CURVES = Sentence("whole-curves-counted",
                        "whole curves of equilibria solve what a diagram would count, {what}")
MORE = Sentence("classify-tells", "stabilab classify tells their stability at one value")()


def chosen(family: Family, borders: bool) -> tuple[str, Reason, OnLine | Conics | None, tuple[Reason, ...]]:
    """(kind, what is counted, the equations or None where all is curves, remarks)."""
    n = family.numbers
    axis = fixed_axis(family)
    if all(c.is_zero() for c in n["M"]):
        return CURVES, CURVES_ALWAYS.then(MORE), None, ()
    if axis is None:
        line = on_line(family)
        if line.special.is_zero():
            return CURVES, CURVES_OF_EQUAL.then(MORE), None, ()
        return ISOLATED, ARE_ISOLATED, line, ()
    if not n["lam"][axis].is_zero():
        item, zero = family.ring.constant(1), family.ring.constant(0)
        load = n["lam"][axis] * n["M"][axis]
        nowhere = OnLine((item, zero, zero), (zero,) * 3, (zero,) * 3, item, load, load)
        return ISOLATED, ARE_ISOLATED, nowhere, (NO_EQUILIBRIUM(axis=Axis(axis + 1)),)
    D = n["D"]
    if borders or "y" not in n:
        return _solvable(BORDERS, STABILITY_CHANGES, across(family, axis, BORDERS))
    others = [i for i in range(3) if i != axis]
    if all((D[i] - D[axis]).is_zero() and n["lam"][i].is_zero() for i in others):
        return CURVES, NO_BALANCE.then(MORE), None, ()
    return _solvable(LEAF, ON_CURVE(axis=Axis(axis + 1)), across(family, axis, LEAF))


def _solvable(kind: str, what: Reason,
              conics: Conics) -> tuple[str, Reason, Conics | None, tuple[Reason, ...]]:
    """The same, or words where the two conics share a curve."""
    common = conics.f.gcd(conics.g) if not (conics.f.is_zero() or conics.g.is_zero()) else None
    if common is None or max(common.degrees()[:2]) > 0:
        return CURVES, WHOLE_CURVES(what=what).then(MORE), None, ()
    return kind, what, conics, ()
