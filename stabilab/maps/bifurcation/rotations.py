"""The rotations of a free body over the momentum or speed of a wheel: at one |H| all of them, or the rotation
about the wheel's own axis at one rate.

With lambda(v) = a + v b the multipliers of the rotations at |H| = h are roots of a polynomial P(m, v)
(`equilibrium.momentum_sphere`), so that their number changes where its discriminant in m vanishes, or where a
pair about an axis d without a wheel begins, h^2 = sum lambda_i(v)^2/(1 - D_i/d)^2. All real roots of these
polynomials in v are isolated exactly; some of them change nothing, as where a component of lambda changes
sign, and those are left out by what is on either side. At one rate about axis k the nature of the rotation
changes where m = w/(D_k w + lambda_k(v)) is 1/D_i, and where H = 0."""
from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from typing import Any, NamedTuple

from flint import Ordering, fmpq_mpoly_ctx

from ...answers.caveats import of_case
from ...answers.dissipation.rotations import SteadyRotation, described, free_only, sphere_of
from ...case.read import Case, read_text, with_data
from ...case.source import parsed
from ...equilibrium.momentum_sphere import MomentumSphere, Rotation, nature_at
from ...errors import InputError, printable
from ...numbers.algebraic import between, univariate
from ...numbers.balls import rational
from ...numbers.polynomial import Poly, real_roots
from ...numbers.vectors import Exact3
from ...reasons import Momentum, Rate, Reasoned, Sentence
from ...representation import Answer, Compared
from ..axes import Span, spans_of, with_values
from ..plan import place_and_text

AT_MOMENTUM = Sentence(
    "rotations-at-momentum", "all rotations at |H| = {momentum}, wheels included: their number changes at "
    "real roots of discriminants, and none is missed")
AT_RATE = Sentence(
    "rotation-at-rate", "the rotation about the axis of the wheels at {rate}: it attracts with losses where "
    "the energy at its |H| is least there")
SAMPLES = 160  # values of a picture or a table of points
CHECKED = (Fraction(1, 3), Fraction(5, 7))  # of the range, where the wheels must be linear in what varies


class RotationPiece(NamedTuple):
    """Between two values, low and high in the unit of the range: the rotations in its middle, at `value`."""

    low: float
    high: float
    value: float
    rotations: tuple[SteadyRotation, ...]

    @property
    def natures(self) -> dict[str, int]:
        """How many of each nature there are, a circle as one."""
        return dict(Counter(item.nature for item in self.rotations))

    @property
    def stable(self) -> int:
        """How many attract where something inside takes energy."""
        return self.natures.get("minimum", 0)


@dataclass(frozen=True, eq=False, repr=False)
class RotationDiagram(Answer, Compared, Reasoned):
    """The rotations of a case over the range of one number.

    case, span: of what varies; momentum: |H|, N m s, or rate: rad/s, whichever is held, the other one None.
    pieces: rising; changes: the values between them, exact (a Fraction) where they are rational, else a
    double, in the unit of the span. rotations: those at any value of it."""

    case: Case
    span: Span
    pieces: tuple[RotationPiece, ...]
    changes: tuple[Fraction | float, ...]
    momentum: float | None = None
    rate: float | None = None
    rotations: Callable[[Fraction], tuple[SteadyRotation, ...]] = field(
        default=lambda value: (), repr=False, compare=False)


@dataclass(frozen=True)
class _Line:
    """A case over a range: D, and lambda = start + value slope, exact."""

    case: Case
    span: Span
    data: dict[str, Any]
    D: Exact3
    start: Exact3
    slope: Exact3

    def wheel(self, value: Fraction) -> Exact3:
        return tuple(a + value * b for a, b in zip(self.start, self.slope))

    def at(self, value: Fraction) -> Any:
        """The scene, a body, at a value."""
        return with_data(self.case.path, self.case.text, with_values(
            self.data, [(self.span.key, self.span.written(value))])).scene


def rotation_diagram(case: Any, vary: Mapping[str, Any] | Sequence[tuple[str, Any]],
                     momentum: Fraction | None = None, rate: Fraction | None = None) -> RotationDiagram:
    """The rotations over the range of one number on which the wheels depend, at |H| = momentum, N m s, or at
    a rate, rad/s, about the axis of the wheels. InputError for two numbers, for what else it changes, for a
    body that is not free, and, at a rate, for wheels along no principal axis."""
    line = _line(case, vary)
    if momentum is not None:
        if momentum < 0:
            raise InputError(f"momentum: expected a size of at least 0, got {float(momentum):g} N m s")
        values, make = _values_at_momentum(line, momentum), _at_momentum(line, momentum)
        reason = AT_MOMENTUM(momentum=Momentum(float(momentum)))
    else:
        rate = rate or Fraction(0)
        values, make = _values_at_rate(line, rate), _at_rate(line, rate)
        reason = AT_RATE(rate=Rate(float(rate)))
    pieces, changes = _pieces(line.span, values, make)
    return RotationDiagram(line.case, line.span, pieces, changes,
                           None if momentum is None else float(momentum),
                           float(rate) if momentum is None and rate is not None else None,
                           lambda value: make(value)[1](), reason=reason,
                           caveats=of_case(line.case))


def sampled(result: RotationDiagram) -> list[tuple[float, tuple[SteadyRotation, ...]]]:
    """(value, the rotations there) at values spread over the range, some of them beside each change."""
    low, width = result.span.low, result.span.high - result.span.low
    values = {low + width * Fraction(n, SAMPLES) for n in range(SAMPLES + 1)}
    for change in (Fraction(value) for value in result.changes):
        values |= {change + sign * width / 10**power for sign in (-1, 1) for power in (3, 4)}
    inside = sorted(value for value in values if low <= value <= result.span.high)
    return [(float(value), result.rotations(value)) for value in inside]


def _line(given: Any, vary: Mapping[str, Any] | Sequence[tuple[str, Any]]) -> _Line:
    path, text = place_and_text("bifurcation", given)
    read = read_text(path, text)
    free_only(read)
    body: Any = read.scene
    data = {key: value for key, value in parsed(path, text)[0].items() if key not in ("sweep", "expect")}
    spans = spans_of(data, list(vary.items() if isinstance(vary, Mapping) else vary))
    if len(spans) > 1:
        raise InputError("vary: at one angular momentum or rate one number may vary, got two")
    span, = spans
    name = printable(span.key.name)
    line = _Line(read, span, data, body.body.exact, (Fraction(0),) * 3, (Fraction(0),) * 3)
    width = span.high - span.low
    first, last = line.at(span.low), line.at(span.high)
    low, high = first.vector("gyrostat"), last.vector("gyrostat")
    slope = tuple((b - a) / width for a, b in zip(low, high))
    start = tuple(a - span.low * b for a, b in zip(low, slope))
    line = _Line(read, span, data, first.body.exact, start, slope)
    if not any(slope):
        raise InputError(f"vary {name}: the wheels do not depend on it; at one angular momentum or rate a "
                         "wheel's speed or momentum may vary")
    for scene, wheel in ((last, high), *((line.at(v), line.wheel(v)) for v in (
            span.low + part * width for part in CHECKED))):
        if scene.body.exact != line.D or scene.vector("gyrostat") != wheel:
            raise InputError(f"vary {name}: it changes more than the wheels, or these not linearly; at one "
                             "angular momentum or rate a wheel's speed or momentum may vary")
    return line


# --- At one |H|
def _values_at_momentum(line: _Line, momentum: Fraction) -> list[tuple[Fraction, bool]]:
    """(value, whether it is exact) of all that may change the number, rising."""
    m, v = fmpq_mpoly_ctx.get(("m", "v"), Ordering.lex).gens()
    square = rational(momentum * momentum)
    weights: dict[Fraction, Any] = {}
    for d, a, b in zip(line.D, line.start, line.slope):
        weights[d] = weights.get(d, 0 * m) + (rational(a) + v * rational(b)) ** 2
    active = {d: w for d, w in weights.items() if w != 0}
    below = {d: 1 - m * rational(d) for d in active}
    P = 0 * m + square
    for d in active:
        P = P * below[d] ** 2
    for d, w in active.items():
        term = w
        for e in active:
            term = term * (below[e] ** 2 if e != d else 1)
        P = P - term
    polynomials = [P.discriminant("m")] if P != 0 else []
    for d in weights:
        if d not in active:
            polynomials.append(square - sum((w * rational(1 / (1 - e / d) ** 2) for e, w in active.items()),
                                            0 * m))
    return _roots_inside(line.span, [Poly.of(univariate(f, 1)) for f in polynomials if f != 0])


def _roots_inside(span: Span, polynomials: Sequence[Poly]) -> list[tuple[Fraction, bool]]:
    result = {root: f(root) == 0 for f in polynomials if f.degree > 0 for root in real_roots(f)
              if span.low < root < span.high}
    return sorted(result.items())


def _at_momentum(line: _Line, momentum: Fraction) -> Any:
    def rotations(value: Fraction) -> tuple[tuple[Rotation, ...], Any]:
        sphere = MomentumSphere(line.D, line.wheel(value), momentum * momentum)
        scene = line.at(value)
        return sphere.rotations, lambda: described(scene, sphere_of(scene, momentum * momentum))
    return rotations


# --- At one rate about the wheels' axis
def _axis(line: _Line) -> int:
    axes = [i for i in range(3) if line.start[i] or line.slope[i]]
    if len(axes) > 1:
        raise InputError("spin: the wheels are along no principal axis, about which alone a body turns at "
                         "one rate whatever their speed: give --momentum instead")
    return axes[0]


def _values_at_rate(line: _Line, rate: Fraction) -> list[tuple[Fraction, bool]]:
    k = _axis(line)
    bounds = [(d - line.D[k]) * rate for i, d in enumerate(line.D) if i != k] + [-line.D[k] * rate]
    return _roots_inside(line.span, [Poly((line.start[k] - bound, line.slope[k])) for bound in bounds])


def _at_rate(line: _Line, rate: Fraction) -> Any:
    k = _axis(line)

    def rotations(value: Fraction) -> tuple[tuple[Rotation, ...], Any]:
        wheel = line.wheel(value)
        omega = tuple(rate if i == k else Fraction(0) for i in range(3))
        H = tuple(d * w + l for d, w, l in zip(line.D, omega, wheel))
        multiplier = rate / H[k] if H[k] else None
        energy = line.D[k] * rate * rate / 2
        rotation = Rotation(nature_at(line.D, wheel, omega), H, omega, energy, multiplier)
        scene = line.at(value)

        def one() -> tuple[SteadyRotation, ...]:
            near = described(scene, sphere_of(scene, H[k] * H[k]))
            return (min(near, key=lambda item: abs(item.rates[k] - float(rate)) + abs(
                item.rates[(k + 1) % 3]) + abs(item.rates[(k + 2) % 3])),)
        return (rotation,), one
    return rotations


def _pieces(span: Span, values: list[tuple[Fraction, bool]],
            make: Any) -> tuple[tuple[RotationPiece, ...], tuple[Fraction | float, ...]]:
    """The pieces between the values at which something changes, and these values."""
    ends = [span.low, *(value for value, _ in values), span.high]
    exact = dict(values)
    samples = [between(low, high) for low, high in zip(ends, ends[1:])]
    kinds = [sorted((item.nature, item.axis) for item in make(value)[0]) for value in samples]
    pieces: list[RotationPiece] = []
    changes: list[Fraction | float] = []
    low = span.low
    for n, value in enumerate(samples):
        if n + 1 < len(samples) and kinds[n + 1] == kinds[n]:
            continue
        pieces.append(RotationPiece(float(low), float(ends[n + 1]), float(value), make(value)[1]()))
        if n + 1 < len(samples):
            low = ends[n + 1]
            changes.append(low if exact[low] else float(low))
    return tuple(pieces), tuple(changes)
