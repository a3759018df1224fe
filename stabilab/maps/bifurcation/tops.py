"""The steady motions of a symmetric top over one number: upright, hanging and leaning, and its critical spin.

With the letters of `physics.symmetric_top`, L = C s + lambda the momentum about the axis without the charge's
part, and the area integral that of the upright top, the lean moves in the effective potential

    U(w) = (2 - w) M^2/(2 A w) + V,    w = 1 + cos(lean),  M = L + E w/2,
    A w^2 U'(w) = F(w) = -M^2 + w (2 - w) E M/2 + A w^2 (|s| + N (C - A)(w - 1)).

The upright top, w = 2, is stable where F(2) < 0; roots of F between 0 and 2 are steady precessions at the
rate M/(A w), stable where F rises. The hanging top is the upright one of the opposite axis: L and |s| change
their signs. The numbers of F are linear in what varies, so that roots appear and vanish at real roots of its
discriminant, of F(2) and of L: all of them are isolated exactly, and one in which nothing changes is left
out by what is on either side."""
from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from math import acos, pi
from typing import Any, NamedTuple

from flint import Ordering, fmpq_mpoly_ctx

from ...answers.caveats import of_case
from ...case.read import Case, with_data
from ...case.table import LEANING, SPINNING
from ...errors import InputError, printable
from ...numbers.algebraic import between, univariate
from ...numbers.balls import rational
from ...numbers.polynomial import Poly, real_roots
from ...physics.scene import Scene
from ...physics.symmetric_top import SymmetricTop
from ...reasons import Reasoned, Sentence
from ...representation import Answer, Compared
from ..axes import Span, spans_of, with_values

STEADY_MOTIONS = Sentence(
    "top-steady-motions", "steady motions with the area integral of the upright or the hanging top: the lean "
    "stays at a critical point of its effective potential; they change at real roots of polynomials, and "
    "none is missed")()
# of the range: where the numbers must be linear in what varies
CHECKED = (Fraction(0), Fraction(1, 3), Fraction(5, 7), Fraction(1))
SAME = Fraction(1, 1 << 180)  # relative, of what is turned to oblique axes
SAMPLES = 160  # values of a picture or a table of points
UPRIGHT, HANGING = "upright", "hanging"


class TopState(NamedTuple):
    """family: "upright" or "hanging", whose area integral it has; lean: of the axis from the upward vertical,
    rad; rate: of its precession, rad/s, 0 on the vertical; stable: whether the lean stays near it."""

    family: str
    lean: float
    rate: float
    stable: bool

    @property
    def leaning(self) -> bool:
        """Whether it is off the vertical."""
        return 0 < self.lean < pi


class TopPiece(NamedTuple):
    """Between two values, low and high in the unit of the range: the states in its middle, at `value`."""

    low: float
    high: float
    value: float
    states: tuple[TopState, ...]

    def stable(self, family: str) -> bool:
        """Whether the axis stays on the vertical, upright or hanging."""
        return next(state.stable for state in self.states if state.family == family and not state.leaning)


@dataclass(frozen=True, eq=False, repr=False)
class TopDiagram(Answer, Compared, Reasoned):
    """The steady motions of a top over the range of one number.

    case, span: of what varies. pieces: rising; changes: the values between them, exact (a Fraction) where
    they are rational, else a double, in the unit of the span; critical: all values at which a polynomial
    vanishes. states: those at any value of the range."""

    case: Case
    span: Span
    pieces: tuple[TopPiece, ...]
    changes: tuple[Fraction | float, ...]
    critical: tuple[Fraction, ...]
    states: Callable[[Fraction], tuple[TopState, ...]] = field(
        default=lambda value: (), repr=False, compare=False)


class _Numbers(NamedTuple):
    """Of F: exact, or polynomials."""

    L: Any
    A: Any
    weight: Any
    field: Any
    charge: Any

    def hanging(self) -> _Numbers:
        """Those of the opposite axis."""
        return self._replace(L=-self.L, weight=-self.weight)

    def F(self, w: Any) -> Any:
        """4 F(w), of the scalars of the numbers."""
        M = w * self.charge + 2 * self.L
        pull = (w - 1) * self.field + self.weight
        return M * (w * self.charge * (2 - w) - M) + w * w * pull * (4 * self.A)


def is_top(scene: Any) -> bool:
    """Whether a diagram of a scene is that of a top."""
    return isinstance(scene, Scene) and not scene.plain and SymmetricTop.of(scene) is not None


def top_diagram(read: Case, data: dict[str, Any], vary: Sequence[tuple[str, Any]] | Mapping[str, Any]
                ) -> TopDiagram:
    """The steady motions of a top over the range of one number on which the momentum about its axis, its
    weight or the field depend linearly. data: of the file. InputError for two numbers, for another one, for
    no start."""
    if read.state is None:
        raise InputError(f"{read.place}: motion: no angular_velocity; the diagram of a top is that of its "
                         "spin")
    data = _spun(read, data)
    spans = spans_of(data, list(vary.items() if isinstance(vary, Mapping) else vary))
    if len(spans) > 1:
        raise InputError("vary: of a top one number may vary, such as its spin, got two")
    span, = spans
    numbers = _linear(read, data, span)
    critical = _critical(span, numbers)
    pieces, changes = _pieces(span, critical, numbers)
    return TopDiagram(read, span, pieces, changes, tuple(value for value, _ in critical),
                      lambda value: _states(numbers(value)), reason=STEADY_MOTIONS, caveats=of_case(read))


def sampled(result: TopDiagram) -> list[tuple[float, tuple[TopState, ...]]]:
    """(value, the states there) at values spread over the range, some of them beside each critical one."""
    low, width = result.span.low, result.span.high - result.span.low
    values = {low + width * Fraction(n, SAMPLES) for n in range(SAMPLES + 1)}
    for at in result.critical:
        values |= {at + sign * width / 10**power for sign in (-1, 1) for power in (3, 4, 5)}
    inside = sorted(value for value in values if low <= value <= result.span.high)
    return [(float(value), result.states(value)) for value in inside]


def _spun(read: Case, data: dict[str, Any]) -> dict[str, Any]:
    """The data with the start of a steady precession as a spin about the axis, which every spin has."""
    motion = data.get("motion", {})
    top = SymmetricTop.of(read.scene)
    if not any(key in motion for key in LEANING) or top is None:
        return data
    axis = top.direction if read.frame is None or read.frame.as_given else read.frame.back(top.direction)
    written = [f"{v.numerator}/{v.denominator}" for v in axis]
    others = {key: value for key, value in motion.items() if key not in (*LEANING, *SPINNING)}
    return data | {"motion": others | {"spin": motion["spin"], "axis": written, "vertical": written}}


def _linear(read: Case, data: dict[str, Any], span: Span) -> Callable[[Fraction], _Numbers]:
    """The numbers of F at a value, or a polynomial for it."""
    name, width = printable(span.key.name), span.high - span.low
    made = [_at(read, data, span, span.low + part * width) for part in CHECKED]
    if any(item is None or item[0] != made[0][0] for item in made):  # type: ignore[index]
        raise InputError(f"vary {name}: the body is no symmetric top about one axis all over the range; its "
                         "spin, its weight or the momentum of a wheel along its axis may vary")
    rows = [item[1] for item in made if item is not None]
    slopes = [(b - a) / width for a, b in zip(rows[0], rows[-1])]
    at = lambda value: _Numbers(*(a + (value - span.low) * slope for a, slope in zip(rows[0], slopes)))
    if not any(slopes):
        raise InputError(f"vary {name}: neither the momentum about the axis of the top nor its weight "
                         "depends on it")
    for part, row in zip(CHECKED, rows):
        line = at(span.low + part * width)
        if any(abs(x - y) > SAME * (abs(x) + max(map(abs, (a, b))))
               for x, y, a, b in zip(row, line, rows[0], rows[-1])):
            raise InputError(f"vary {name}: the numbers of the top do not depend on it linearly all over the "
                             "range; its spin, its weight or the momentum of a wheel along its axis may vary")
    return at


def _at(read: Case, data: dict[str, Any], span: Span, value: Fraction) -> tuple[Any, _Numbers] | None:
    """((axis, side), numbers) at a value; None where it is no top."""
    case = with_data(read.path, read.text, with_values(data, [(span.key, span.written(value))]))
    top = SymmetricTop.of(case.scene)
    if top is None or case.exact_state is None:
        return None
    spin, _ = top.seen(case.exact_state, top.direction)
    L = top.momentum(spin, Fraction(0))
    return (top.axis, top.side), _Numbers(L, top.A, top.weight, top.field, top.charge)


def _critical(span: Span, numbers: Callable[[Any], _Numbers]) -> list[tuple[Fraction, bool]]:
    """(value, whether it is exact) of all that may change the states, rising."""
    w, v = fmpq_mpoly_ctx.get(("w", "v"), Ordering.lex).gens()
    low, high = numbers(span.low), numbers(span.high)
    line = _Numbers(*(rational(a) + (v - rational(span.low)) * rational((b - a) / (span.high - span.low))
                      for a, b in zip(low, high)))
    polynomials = [line.L]
    for item in (line, line.hanging()):
        F = item.F(w)
        polynomials += [item.F(0 * w + 2), *([F.discriminant("w")] if F.degrees()[0] > 1 else [])]
    found = {root: f(root) == 0 for f in (Poly.of(univariate(g, 1)) for g in polynomials if g != 0)
             if f.degree > 0 for root in real_roots(f) if span.low < root < span.high}
    return sorted(found.items())


def _states(numbers: _Numbers) -> tuple[TopState, ...]:
    """All of them at exact numbers, upright and what has its area integral first."""
    result = []
    for family, item in ((UPRIGHT, numbers), (HANGING, numbers.hanging())):
        hangs = family == HANGING
        result.append(TopState(family, pi if hangs else 0.0, 0.0, item.F(Fraction(2)) < 0))
        F = item.F(Poly((0, 1)))
        for w in real_roots(F) if F.degree > 0 else ():
            if 0 < w < 2:
                lean = acos(max(-1.0, min(1.0, float(w - 1))))
                rate = float((item.L + item.charge * w / 2) / (item.A * w))
                result.append(TopState(family, pi - lean if hangs else lean, -rate if hangs else rate,
                                       F.derivative()(w) > 0))
    return tuple(result)


def _pieces(span: Span, values: list[tuple[Fraction, bool]], numbers: Callable[[Any], _Numbers]
            ) -> tuple[tuple[TopPiece, ...], tuple[Fraction | float, ...]]:
    """The pieces between the values at which something changes, and these values."""
    ends = [span.low, *(value for value, _ in values), span.high]
    exact, pieces, changes, low = dict(values), [], [], span.low
    samples = [between(a, b) for a, b in zip(ends, ends[1:])]
    found = [_states(numbers(value)) for value in samples]
    kinds = [[(state.family, state.leaning, state.stable) for state in states] for states in found]
    for n, value in enumerate(samples):
        last = n + 1 == len(samples)
        if not last and kinds[n + 1] == kinds[n]:
            continue
        pieces.append(TopPiece(float(low), float(ends[n + 1]), float(value), found[n]))
        if not last:
            low = ends[n + 1]
            changes.append(low if exact[low] else float(low))
    return tuple(pieces), tuple(changes)
