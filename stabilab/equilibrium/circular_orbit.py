"""All equilibria of a satellite on a circular orbit, and how they change with the wheels' momentum.

Their number as the momentum of the wheels grows along one direction changes at isolated momenta only.

With a momentum s h the equations F = G = 0 of `circular_orbit_places` are polynomials in s^2. The number of
their real common points, and of the roots of the balances across the principal axes, can change only where
the resultant R(u, s^2) gets a double root, loses its leading coefficient or vanishes: at roots of polynomials
in s with exact coefficients (discriminants, resultants of factors, leading coefficients, contents). They are
all isolated, and between two of them the equilibria at one rational s stand for all.

For pictures the equilibria are followed as the momentum grows.

At each of some momenta between two changes of their number all are found, exactly, each with its verdict.
What belongs together at two neighbouring momenta is what lies nearest, of all their pairs the nearest first.
"""
from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from fractions import Fraction
from itertools import combinations
from math import atan2, cos, dist, hypot, pi, sqrt
from typing import Any, NamedTuple

from flint import Ordering, arb, fmpq_mpoly, fmpq_mpoly_ctx, fmpq_poly

from ..numbers.algebraic import coefficients, cuts, gaps, univariate
from ..numbers.balls import Digits, Unclear, rational, settled
from ..numbers.vectors import CYCLE, Float3, cross, dot, nearest_first
from ..physics.circular_orbit import Satellite
from ..reasons import Reason, Reasoned, Sentence
from .circular_orbit_places import (
    FLAT,
    Family,
    Line,
    Signs,
    about,
    along_curve,
    characteristic_coefficients,
    directions,
    eigenvectors,
    forms,
    isolated,
    plane_of,
    signs_at,
    symmetry,
    turned,
    verdict_of,
)


# --- The answer
@dataclass(frozen=True)
class OrbitEquilibrium(Reasoned):
    """An attitude at rest in the orbital frame.

    velocity, normal, vertical: unit vectors of the orbital frame (along the velocity, normal to the orbit in
    the sense of the angular momentum, up) in the body frame: the rows of the matrix of direction cosines.
    linear: "stable" (all eigenvalues imaginary, none zero), "unstable" or "degenerate"; verdict: "stable",
    "unstable" or "undecided" (Lyapunov's sense, for the full motion), reason: its proof, because: the same in
    words. minimum: whether the dynamic potential has a definite minimum here. eigenvalues: six, 1/s;
    frequencies: of librations, rad/s, rising. potential: the dynamic potential, J. consists: of one attitude
    of a continuous family, what the family consists of, None of an isolated one; family: the same in words.
    axis: of the body, about which the family turns, or None.
    """

    velocity: Float3
    normal: Float3
    vertical: Float3
    linear: str
    verdict: str
    minimum: bool
    eigenvalues: tuple[complex, ...]
    frequencies: tuple[float, ...]
    potential: float
    consists: Reason | None = None
    axis: Float3 | None = None

    @property
    def family(self) -> str:
        """What the family consists of, in words; empty of an isolated one."""
        return "" if self.consists is None else self.consists.text()

    @property
    def angles(self) -> Float3:
        """Yaw, pitch and roll, rad, see `yaw_pitch_roll`."""
        return yaw_pitch_roll(self.velocity, self.normal, self.vertical)


@dataclass(frozen=True)
class OrbitEquilibria(Reasoned):
    """All of them. kind: "points" (isolated ones alone), "curves" (continuous families, perhaps with isolated
    ones) or "all" (every attitude); reason: why these and no others, because: the same in words. points:
    isolated, in pairs that a half turn about the orbit normal leads into each other, the stable ones first;
    families: one attitude of each.
    """

    kind: str
    points: tuple[OrbitEquilibrium, ...] = ()
    families: tuple[OrbitEquilibrium, ...] = ()

    def count(self, verdict: str) -> int:
        """How many isolated ones have this verdict."""
        return sum(point.verdict == verdict for point in self.points)


def yaw_pitch_roll(velocity: Float3, normal: Float3, vertical: Float3) -> Float3:
    """Yaw, pitch and roll, rad, of the sequence 3-2-1 from the frame (velocity, against the orbit normal,
    down) to the body; where the pitch is a right angle only yaw and roll together are determined: the roll is
    0."""
    # body axes in that frame, without zeros of negative sign, which would be half turns backwards
    rows = [(0.0 + v, 0.0 - n, 0.0 - up) for v, n, up in zip(velocity, normal, vertical)]
    (xx, xy, xz), (yx, yy, yz), (_, _, zz) = rows
    across = hypot(xx, xy)
    if across < 1e-9:  # rounding alone turns yaw and roll there
        return atan2(0.0 - yx, yy), atan2(0.0 - xz, across), 0.0
    return atan2(xy, xx), atan2(0.0 - xz, across), atan2(yz, zz)


# --- All equilibria
BITS = 256  # of the numbers behind the doubles of an answer, at first
NOTHING, ENOUGH = 2.0**-150, 2.0**-100  # of a number of the size of 1; of a ball's width, relative
ORDER = ("stable", "undecided", "unstable")
EVERY = Sentence(
    "orbit-every-attitude",
    "all moments are equal and there is no wheel momentum: no torque acts, every attitude is an "
    "equilibrium")()
COMPLETE = Sentence(
    "orbit-complete",
    "each line of the vertical is a real root of polynomials with exact coefficients, none is missed; a "
    "half turn about the orbit normal leads to the other of each pair")()
SPREAD = Sentence("orbit-turns-change-nothing", "turns about an axis of the body change nothing")()
ON_CURVE = Sentence("orbit-on-curve", "on a curve of equilibria, or next to one")()
LEAST = Sentence(
    "orbit-least",
    "the dynamic potential is flat to second order here, but less than at any other equilibrium: the Jacobi "
    "integral is a Lyapunov function")()
CURVED = Sentence(
    "orbit-common-factor",
    "the equations have a common factor at exactly this wheel momentum")()


class _Solved(NamedTuple):
    """An equilibrium with the exact signs behind its verdict and a ball about its dynamic potential."""

    one: OrbitEquilibrium
    signs: Signs
    potential: arb


def orbit_equilibria(satellite: Satellite) -> OrbitEquilibria:
    """Every equilibrium in the orbital frame, none missed and none invented."""
    k = symmetry(satellite)
    if k == 3 and not any(satellite.momentum):
        return OrbitEquilibria("all", reason=EVERY)
    if k is not None:
        return OrbitEquilibria("curves", (), _of(satellite, turned(satellite, k)),
                               reason=SPREAD.then(COMPLETE))
    places = isolated(satellite)
    points = [item for line in places.lines for item in _solved(satellite, line)]
    families = () if places.curve is None else _of(satellite, along_curve(satellite, *places.curve))
    if families:
        on = [replace(solved.one, consists=ON_CURVE) for solved in points if not solved.signs.determinant]
        families, points = _sorted([*on, *families]), [point for point in points if point.signs.determinant]
    else:
        points = [_with_least(solved, points) for solved in points]
    pairs = tuple(other for item in _sorted([solved.one for solved in points])
                  for other in (item, _half_turned(item)))
    return OrbitEquilibria("curves" if families else "points", pairs, families,
                           reason=CURVED.then(COMPLETE) if families else COMPLETE)


def _of(satellite: Satellite, families: Iterable[Family]) -> tuple[OrbitEquilibrium, ...]:
    return _sorted([solved.one for family in families for solved in _solved(satellite, family.line, family)])


def _sorted(result: Iterable[OrbitEquilibrium]) -> tuple[OrbitEquilibrium, ...]:
    return tuple(sorted(result, key=lambda item: (ORDER.index(item.verdict), item.potential)))


def _with_least(solved: _Solved, points: Iterable[_Solved]) -> _Solved:
    """Stable where the dynamic potential, flat to second order, is less than at all others: it is least
    somewhere on the compact set of attitudes, and an isolated place of that kind is a strict minimum."""
    if solved.one.reason != FLAT or not all(solved.potential < other.potential for other in points
                                             if other is not solved):
        return solved
    return solved._replace(one=replace(solved.one, verdict="stable", reason=LEAST))


def _half_turned(item: OrbitEquilibrium) -> OrbitEquilibrium:
    """The other one of a pair: turned about the orbit normal by half a turn."""
    back = lambda v: tuple(0.0 - c for c in v)
    return replace(item, velocity=back(item.velocity), vertical=back(item.vertical))


def _solved(satellite: Satellite, line: Line, family: Family | None = None) -> list[_Solved]:
    """One attitude for each real root of the line's polynomial."""
    return [_attitude(satellite, line, index, family) for index in range(len(line.roots(BITS)))]


def _attitude(satellite: Satellite, line: Line, index: int, family: Family | None) -> _Solved:
    signs = signs_at(satellite, line, index, family is not None)
    linear, verdict, reason = verdict_of(signs, family is not None)
    axis = None if family is None or family.axis is None else tuple(map(float, family.axis))
    size = rational(satellite.rate_squared * max(satellite.moments))

    def asked(digits: Digits) -> _Solved:
        X, omega, reciprocal = line.at(line.roots(digits.bits)[index])
        scale, rate = arb(reciprocal).sqrt(), arb(rational(satellite.rate_squared)).sqrt()
        up, normal = tuple(v * scale for v in X), tuple(w / rate for w in omega)
        potential = _potential(satellite, up, omega)
        _, cubic = characteristic_coefficients(satellite, omega, X, reciprocal)
        squares = _squares(satellite, cubic, signs)
        return _Solved(OrbitEquilibrium(
            _doubles(cross(normal, up)), _doubles(normal), _doubles(up), linear, verdict,
            signs.minimum, _eigenvalues(squares),
            tuple(sorted(sqrt(-m.real) for m in squares if not m.imag and m.real < 0)),
            _doubles([potential / size])[0] * float(size), family.consists if family else None,
            axis and tuple(v / hypot(*axis) for v in axis), reason=reason), signs, potential)
    return settled(asked, BITS)


def _potential(satellite: Satellite, up: tuple[arb, ...], omega: tuple[arb, ...]) -> arb:
    """3/2 n^2 a3 . I a3 - w . I w/2 - h . w with w = n a2."""
    A, h = (tuple(map(rational, row)) for row in (satellite.moments, satellite.momentum))
    drawn, spun = (sum((d * v * v for d, v in zip(A, row)), arb(0)) for row in (up, omega))
    return 3 * rational(satellite.rate_squared) * drawn / 2 - spun / 2 - dot(h, omega)


def _doubles(values: Iterable[arb]) -> tuple[float, ...]:
    """Numbers of the size of 1 as doubles; below `NOTHING` they are zero. Unclear of a ball that is too wide.
    """
    return tuple(float(v.mid()) for v in map(_narrow, values))


def _narrow(value: arb) -> arb:
    """The ball's middle, where it has more digits than a double or is as good as zero."""
    if abs(value) < NOTHING:
        return arb(0)
    if not value.rad() < ENOUGH * abs(value):
        raise Unclear
    return value.mid()


def _squares(satellite: Satellite, cubic: Sequence[arb], signs: Signs) -> list[complex]:
    """The squares of the eigenvalues, 1/s^2: real ones exactly real, the one of a zero determinant zero."""
    n2, product = rational(satellite.rate_squared), cubic[0]
    scaled = [_narrow(arb(c) / product / n2**k) for k, c in enumerate(cubic)]
    if not signs.determinant:
        scaled[3] = arb(0)
    roots: list[Any] = fmpq_poly([c.fmpq() for c in reversed(scaled)]).complex_roots()
    real, size = signs.discriminant >= 0, float(n2)
    return [complex(float(root.real.mid()) * size, 0.0 if real else float(root.imag.mid()) * size)
            for root, times in roots for _ in range(times)]


def _eigenvalues(squares: list[complex]) -> tuple[complex, ...]:
    """Both roots of each, exactly real or imaginary where the square is real."""
    out = []
    for m in sorted(squares, key=lambda m: (m.imag != 0, m.real, m.imag)):
        root = m**0.5 if m.imag else complex(sqrt(m.real)) if m.real > 0 else complex(0.0, sqrt(-m.real))
        out += [root, complex(0.0 - root.real, 0.0 - root.imag)]
    return tuple(out)


# --- Their number over the momentum of the wheels
@dataclass(frozen=True)
class MomentumSpan:
    """From `low` to `high`, in units of the satellite's own momentum: how many equilibria there are, and how
    many of them are minima of the dynamic potential, which are stable. Of a body with an axis of symmetry:
    how many families."""

    low: float
    high: float
    count: int
    minima: int
    families: bool = False


def spans(satellite: Satellite, largest: Fraction) -> tuple[MomentumSpan, ...]:
    """The open intervals of s in (0, most), for a momentum s times the satellite's, which is not zero; the
    number is that of the whole interval and differs from the next one's, in all or in minima."""
    result = cuts((factor for f in _critical(satellite) for factor, _ in f.factor()[1]), Fraction(0), largest)
    joined: list[MomentumSpan] = []
    for gap in gaps(result, Fraction(0), largest):
        if gap is None:
            continue
        span = _counted(satellite, gap.low, gap.high, gap.sample)
        last = joined[-1] if joined else None
        if last and (last.count, last.minima) == (span.count, span.minima):
            joined[-1] = replace(last, high=span.high)
        else:
            joined.append(span)
    return tuple(joined)


def _counted(satellite: Satellite, low: float, high: float, s: Fraction) -> MomentumSpan:
    result = orbit_equilibria(replace(satellite, momentum=tuple(s * h for h in satellite.momentum)))
    every = result.points or result.families
    stable = [item for item in every if item.minimum or (item.family and item.verdict == "stable")]
    return MomentumSpan(low, high, len(every), len(stable), not result.points)


def _critical(satellite: Satellite) -> Iterator[fmpq_poly]:
    """Polynomials in s, one of which is zero wherever the number changes."""
    k, s2, n2 = symmetry(satellite), fmpq_poly([0, 0, 1]), rational(satellite.rate_squared)
    if k == 3:
        return
    if k is not None:
        C, A = (rational(satellite.moments[n]) for n in (k, CYCLE[k][0]))
        for times in (1, 16):
            yield rational(satellite.momentum[k])**2 * s2 - times * n2 * (C - A)**2
        return
    yield from _across(satellite)
    yield from (f(s2 / n2) for f in _oblique(replace(satellite, rate_squared=Fraction(1))))


def _across(satellite: Satellite) -> Iterator[fmpq_poly]:
    """Of the vertical along a principal axis: see `circular_orbit_places.plane`."""
    axes, h, n2 = eigenvectors(satellite), satellite.momentum, rational(satellite.rate_squared)
    ring = fmpq_mpoly_ctx.get(("t", "s"), Ordering.lex)
    t, s = ring.gens()
    for k, (i, j) in enumerate(CYCLE):
        if dot(h, axes[k]):
            continue
        (A, p, a), (B, q, b) = (map(rational, about(satellite, axes[n])) for n in (i, j))
        D = B - A
        if p != 0 and q != 0:
            quartic = (a * t**2 - n2) * (D * t - p * s)**2 + b * q**2 * s**2 * t**2
            yield from _singular([quartic], "t")
        else:
            yield fmpq_poly([-n2 * D**2, 0, a * p**2 + b * q**2])


def _oblique(satellite: Satellite) -> list[fmpq_poly]:
    """Of the vertical off the principal axes, on an orbit of rate 1: polynomials in s^2."""
    ring = fmpq_mpoly_ctx.get(("u", "v", "s"), Ordering.lex)
    u, v, s = ring.gens()
    for matrix in directions(satellite):
        F, G = forms(satellite, plane_of(matrix, u, v), s)
        R = F.resultant(G, "v")
        factors = [(f, times) for f, times in R.factor()[1]]
        moving = [f for f, _ in factors if f.degrees()[0] and f.degrees()[2]]
        if R.degrees()[0] < 20 or F.degrees()[1] < 4 or any(times > 1 for f, times in factors if f in moving):
            continue  # a point is at infinity, or two are in line whatever s is
        resting = [f for f, _ in factors if f.degrees()[0] == 1 and not f.degrees()[2]]  # principal axes
        contents = [univariate(f, -1) for f, _ in factors if not f.degrees()[0]]
        return [*contents, *_singular([*moving, *resting], "u")]
    raise ArithmeticError("no direction of elimination tells the equilibria apart")


def _singular(factors: Iterable[fmpq_mpoly], variable: str) -> Iterator[fmpq_poly]:
    """Where one of them has a double root, two share one, or a root is at infinity; in the last variable."""
    every = list(factors)
    for f in every:
        yield univariate(coefficients(f, 0)[-1], -1)
        if f.degrees()[0] > 1:
            yield univariate(f.discriminant(variable), -1)
    for f, g in combinations(every, 2):
        yield univariate(f.resultant(g, variable), -1)


# --- Their branches over it, for pictures
SPAN_POINTS = 24  # of a span: close at its ends, where branches meet as square roots do
BRANCH_BITS = 24  # of all numbers, far more than a picture shows: short ones are eliminated soon
FINE = 1 << 16  # the share of a span, far above what `BITS` leave open, that momenta are whole numbers of


@dataclass
class Branch:
    """verdict: of all its equilibria; momenta: rising, in units of the satellite's own; points: one of each
    pair that a half turn about the orbit normal leads into each other."""

    verdict: str
    momenta: list[float] = field(default_factory=list)
    points: list[OrbitEquilibrium] = field(default_factory=list)

    def add(self, momentum: float, point: OrbitEquilibrium) -> Branch:
        self.momenta.append(momentum)
        self.points.append(point)
        return self


def branches(satellite: Satellite, spans: Iterable[MomentumSpan]) -> list[Branch]:
    """The branches over spans of the momentum; of a satellite without a continuous symmetry. A branch whose
    verdict changes ends and another one begins at its last point."""
    done: list[Branch] = []
    for span in spans:
        going: list[Branch] = []
        for s in _momenta(span):
            momentum = tuple(s * h for h in satellite.momentum)
            result = orbit_equilibria(replace(satellite, momentum=momentum).rounded(BRANCH_BITS)).points[::2]
            going = _joined(going, float(s), result, done)
        done += going
    return done


def _momenta(span: MomentumSpan) -> list[Fraction]:
    low, width = Fraction(span.low), Fraction(span.high) - Fraction(span.low)
    steps = dict.fromkeys(min(FINE - 1, max(1, round(FINE * (1 - cos(pi * n / SPAN_POINTS)) / 2)))
                          for n in range(SPAN_POINTS + 1))
    return [low + width * n / FINE for n in steps]


def _joined(going: Sequence[Branch], s: float, result: Sequence[OrbitEquilibrium],
            done: list[Branch]) -> list[Branch]:
    """The branches that go on to the equilibria at the next momentum; those that end are added to `done`."""
    if len(going) != len(result):
        done += going
        return [Branch(entry.verdict).add(s, entry) for entry in result]
    paired = nearest_first((_apart(branch.points[-1], entry), i, j) for i, branch in enumerate(going)
                           for j, entry in enumerate(result))
    before = {j: i for i, j in paired.items()}
    out = []
    for j, item in enumerate(result):
        branch = going[before[j]]
        if branch.verdict != item.verdict:
            done.append(branch)
            branch = Branch(item.verdict).add(branch.momenta[-1], branch.points[-1])
        out.append(branch.add(s, item))
    return out


def _apart(x: OrbitEquilibrium, other: OrbitEquilibrium) -> float:
    """How far two pairs are apart: by the normal, and by the vertical up or down."""
    down = tuple(-v for v in other.vertical)
    return dist(x.normal, other.normal) + min(dist(x.vertical, other.vertical), dist(x.vertical, down))
