"""Principal axes of a symmetric tensor of rationals, without a rounding that is not known.

Whether a tensor has positive moments is decided by signs of exact coefficients. Its principal moments are the
roots of its characteristic polynomial: rational ones are exact, the others are enclosed. The direction of a
rational moment is exact, and the other two are exactly across it, so a torque along it has no component
across it. A length that is irrational has the same error. `error` bounds what is left, proved by the residual
and the gaps (Davis and Kahan 1970).

Numbers that were computed before they were written, by a rotation in doubles say, carry its rounding: they
show it by their many digits (`rounding`). Within it moments are equal, and a vector has no component along
an axis. Numbers of a few digits, and ratios, mean exactly what they say.
"""
from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from itertools import combinations
from typing import TypeAlias

from ..errors import InputError
from ..reasons import Inertia, Quantity, Reason, Sentence
from .balls import rational
from .exact import Rounded, sqrt_fraction
from .polynomial import Poly, real_roots
from .vectors import Exact3, Number, Triple, cross, dot

Rows: TypeAlias = Sequence[Sequence[Fraction]]  # of a 3 x 3 matrix
Moment: TypeAlias = tuple[Fraction, bool]  # and whether it is exact
IRRATIONAL_BITS = 240  # of the numbers that cannot be rational
IDENTITY = tuple(tuple(Fraction(i == j) for j in range(3)) for i in range(3))
TURNED = (IDENTITY[1], IDENTITY[2], IDENTITY[0])  # as good as any of a sphere that is not diagonal
NAMES = "xyz"
ENTRY = 15  # digits of an entry in an error, which all decimals of so many keep
# of a vector: a component as small is what irrational axes, good to IRRATIONAL_BITS, leave of zero
NOTHING = Fraction(1, 1 << 200)
# of the largest entry of a matrix that was turned and written again: what counts as zero
SLACK = Fraction(1, 1 << 100)
MANY_DIGITS, MANY_BITS = 12, 46  # of a decimal and of a double: so many are of a number that was computed
LONG = 230  # bits of a denominator that only a rounded root has
ULP = Fraction(1, 1 << 52)
DOUBLES = Fraction(1, 1 << 48)  # of the largest number: what a rotation in doubles leaves
MAX_ZEROED = Fraction(1, 1 << 26)  # of a vector: a component that is as large is not made zero
# a cosine far above that and its rounding; the size from which on products of doubles have all their digits
OBLIQUE, TINY = 2.0**-20, 1e-250


def rounding(values: Iterable[Number]) -> Fraction:
    """How far each of the numbers of one tensor or vector may be off for having been computed and rounded, by
    the digits that they show; 0 where none has many."""
    numbers = [Fraction(v) for v in values if v]
    units = [unit for unit in map(_last_digit, numbers) if unit]
    return max(units) + DOUBLES * max(map(abs, numbers)) if units else Fraction(0)


def _last_digit(value: Fraction) -> Fraction:
    """The unit of the last digit of a decimal, a double or a root of many digits; 0 of any other number."""
    bottom, powers = value.denominator, [0, 0]
    for n, prime in enumerate((2, 5)):
        while bottom % prime == 0:
            bottom, powers[n] = bottom // prime, powers[n] + 1
    if bottom > 1:  # a ratio, as it is meant or as roots make them
        return abs(value) * ULP if value.denominator.bit_length() > LONG else Fraction(0)
    if powers[0] and not powers[1] and abs(value.numerator).bit_length() >= MANY_BITS:
        return abs(value) * ULP
    places = max(powers)
    digits = len(str(abs(value.numerator) * 10**places // value.denominator).rstrip("0"))
    return Fraction(0) if digits < MANY_DIGITS else max(Fraction(1, 10**places), abs(value) * ULP)


def settled(vector: Exact3) -> Exact3:
    """A direction without the components that are within its rounding, as cosines of right angles are."""
    slack = rounding(vector)
    return tuple(Fraction(0) if abs(v) <= slack else v for v in vector)


def crossed(first: Exact3, second: Exact3) -> Exact3:
    """Their cross product, without components that are within what their roundings leave."""
    off, large = (rounding(first), rounding(second)), (max(map(abs, first)), max(map(abs, second)))
    slack = 2 * (off[0] * large[1] + off[1] * large[0])
    return tuple(Fraction(0) if abs(v) <= slack <= MAX_ZEROED * large[0] * large[1] else v
                 for v in cross(first, second))


def summed(vectors: Sequence[Exact3]) -> Exact3:
    """Their sum, without a component that only their roundings leave where terms of it cancel."""
    rows = []
    for column in zip(*vectors):
        total, terms = sum(column, Fraction(0)), [v for v in column if v]
        slack = sum(map(rounding, vectors), Fraction(0)) if total and len(terms) > 1 else 0
        lost = abs(total) <= slack <= MAX_ZEROED * max(map(abs, terms), default=0)
        rows.append(Fraction(0) if lost else total)
    return tuple(rows)


@dataclass(frozen=True, repr=False)
class PrincipalAxes(Rounded):
    """moments: three, in the tensor's unit; axes: rows, unit vectors of the principal axes in the input
    frame, right-handed.

    exact: whether both are without error; else error bounds that of every moment relative to the largest and,
    as an angle in rad, that of every axis. A tensor that is diagonal keeps its order; else the moments
    descend. rounding: in the tensor's unit, by how much a moment may be off for the rounding that its numbers
    show; equal ones are equal within it.
    """

    moments: Exact3
    axes: tuple[Exact3, ...]
    exact: bool
    error: Fraction = Fraction(0)
    rounding: Fraction = Fraction(0)

    @property
    def as_given(self) -> bool:
        """Whether the principal axes are those of the input."""
        return self.axes == IDENTITY

    def turned(self, vector: Sequence[Number]) -> Triple:
        """The components along the principal axes of a vector of the input frame, zero where they are within
        what the roundings of tensor and vector leave of zero."""
        if self.as_given:
            return tuple(vector)
        result = tuple(sum(a * v for a, v in zip(axis, vector)) for axis in self.axes)
        if not all(isinstance(v, (int, Fraction)) for v in vector) or not any(result):
            return result
        own, largest = 2 * rounding(vector), max(map(abs, result))
        return tuple(v * 0 if v and abs(v) <= own + self._leak(i, result) <= MAX_ZEROED * largest else v
                     for i, v in enumerate(result))

    def _leak(self, i: int, vector: Triple) -> Fraction:
        """The most that axis i, being off, shows of the other components of a vector: by an angle of at most
        2 rounding/gap towards an axis of another moment, and by its own error."""
        gaps = [abs(self.moments[i] - moment) for moment in self.moments]
        return sum((abs(v) * (2 * self.error + (2 * self.rounding / gap if gap else 0))
                    for v, gap in zip(vector, gaps)), Fraction(0))

    def fitted(self, vectors: Iterable[Sequence[Fraction]]) -> PrincipalAxes:
        """Where moments are equal, of all the axes that are principal there those along which the first of
        the vectors (input frame) lies that has a component across the others, then the second; else itself.
        What lies along it, or across it, then has as many zeros as it can."""
        free = [i for i in range(3) if self.moments.count(self.moments[i]) > 1]
        result = self
        for vector in vectors:
            parts = result.turned(vector)
            along = [i for i in free if parts[i]]
            if len(along) > 1:
                result = result._led(free, parts)
            if along:
                free.remove(along[0] if len(along) == 1 else free[0])
            if len(free) < 2:
                break
        return result

    def _led(self, free: Sequence[int], parts: Triple) -> PrincipalAxes:
        """With the first of the free axes along a vector of these components."""
        axes, bits = list(self.axes), IRRATIONAL_BITS + 32
        mixed = lambda *shares: tuple(sum(fraction * axes[i][n] for fraction, i in zip(shares, free))
                                      for n in range(3))
        new = ([mixed(parts[free[0]], parts[free[1]]), mixed(-parts[free[1]], parts[free[0]])]
               if len(free) == 2 else _with_plane(mixed(*parts)))
        for i, direction in zip(free, new):
            axes[i] = _unit(direction if self.exact else _rounded(direction, bits), bits)
        exact = self.exact and all(dot(axis, axis) == 1 for axis in axes)
        return replace(self, axes=tuple(axes), exact=exact,
                       error=self.error if exact else max(self.error, Fraction(1, 1 << IRRATIONAL_BITS)))

    def back(self, vector: Sequence[Number]) -> Triple:
        """The components in the input frame of a vector given along the principal axes."""
        return (tuple(vector) if self.as_given
                else tuple(sum(self.axes[i][j] * vector[i] for i in range(3)) for j in range(3)))


def clearly_oblique(vector: Sequence[Number], other: Sequence[Number]) -> bool:
    """Whether doubles show that two vectors are far from right angles, so that `without_trace` leaves the
    first as it is."""
    terms = [float(v) * float(o) for v, o in zip(vector, other)]
    return abs(sum(terms)) > OBLIQUE * math.hypot(*map(float, vector)) * math.hypot(*map(float, other)) > TINY


def without_trace(vector: Exact3, other: Exact3) -> Exact3:
    """A vector without the trace along another one that roundings leave where the two are at right angles:
    those of irrational axes, and those that the digits of the two show."""
    if clearly_oblique(vector, other):
        return vector
    level, size = dot(vector, other), dot(other, other)
    if not level:
        return vector
    smallest = NOTHING * NOTHING * size * dot(vector, vector)
    terms = sum(abs(v * o) for v, o in zip(vector, other))
    if level * level > smallest and abs(level) > MAX_ZEROED * terms:
        return vector  # whatever the digits show, and to count these takes longer
    open_ = sum(abs(v) for v in vector) * rounding(other) + sum(abs(v) for v in other) * rounding(vector)
    if level * level > smallest and not abs(level) <= open_ <= MAX_ZEROED * terms:
        return vector
    return tuple(v - level / size * o for v, o in zip(vector, other))


def oblique(frame: PrincipalAxes | None) -> PrincipalAxes | None:
    """The axes, where they are not those of the frame that the tensor was given in."""
    return None if frame is None or frame.as_given else frame


def principal_axes(tensor: Sequence[Sequence[Number]], off: Fraction = Fraction(0)) -> PrincipalAxes:
    """The principal moments and axes of an inertia tensor: 3 x 3 exact numbers, each of which may be `off` by
    so much, or as much as its digits show. Raises InputError where it is not symmetric or a moment is not
    positive; that the largest exceeds the sum of the others, as of no rigid body, is for `Body` to say."""
    rows = tuple(tuple(Fraction(v) for v in row) for row in tensor)
    wrong = fault_of(rows)
    if wrong:
        raise InputError(wrong.text())
    # of the tensor's norm, and so of every moment
    slack = 3 * max(off, rounding(entries(rows)))
    if not any(rows[i][j] for i in range(3) for j in range(3) if i != j):
        supplied = tuple(rows[i][i] for i in range(3))
        order = sorted(range(3), key=lambda i: -supplied[i])
        similar = _made_equal([(supplied[i], True) for i in order], slack)
        return PrincipalAxes(tuple(similar[order.index(i)][0] for i in range(3)), IDENTITY, True, Fraction(0),
                             slack)
    polynomial, bits = _characteristic(rows), IRRATIONAL_BITS + 32
    while True:
        moments = _made_equal(_moments(rows, polynomial, bits), slack)
        if len({value for value, _ in moments}) == 1:  # a sphere, to its last digit: any axes do
            return PrincipalAxes(tuple(value for value, _ in moments), TURNED, True, Fraction(0), slack)
        result = _axes(rows, moments, bits)
        if result and result.error < Fraction(1, 1 << IRRATIONAL_BITS):
            return replace(result, rounding=slack)
        bits *= 2


def _made_equal(moments: Sequence[Moment], slack: Fraction) -> tuple[Moment, ...]:
    """Three moments, descending; those within what rounding leaves of each other with the value that keeps
    their sum."""
    (first, _), (second, _), (third, _) = moments
    if first - third <= 2 * slack:
        mean = (first + second + third) / 3
        return tuple((mean, mean == value) for value, _ in moments)
    upper, lower = first - second, second - third
    if 0 < upper <= min(2 * slack, lower):
        return ((first + second) / 2, False), ((first + second) / 2, False), moments[2]
    if 0 < lower <= 2 * slack:
        return moments[0], ((second + third) / 2, False), ((second + third) / 2, False)
    return tuple(moments)


def entries(rows: Rows) -> list[Number]:
    """Those of a matrix in one list."""
    return [v for row in rows for v in row]


def evened(rows: Rows, fraction: Fraction) -> Rows:
    """A 3 x 3 matrix with the mean of two entries across its diagonal that differ by no more than a share of
    its largest entry, which is what rounding leaves."""
    slack = fraction * max(abs(v) for row in rows for v in row)
    return [[(v + rows[j][i]) / 2 if abs(v - rows[j][i]) <= slack else v for j, v in enumerate(row)]
            for i, row in enumerate(rows)]


def principal_minors(rows: Sequence[Sequence[Number]]) -> Iterator[tuple[int, Number]]:
    """(order, value) of the seven principal minors of a 3 x 3 matrix of any numbers."""
    for i in range(3):
        yield 1, rows[i][i]
    for i, j in combinations(range(3), 2):
        yield 2, rows[i][i] * rows[j][j] - rows[i][j] * rows[j][i]
    (a, b, c), (d, e, f), (g, h, k) = rows
    yield 3, a * (e * k - f * h) - b * (d * k - f * g) + c * (d * h - e * g)


NOT_SYMMETRIC = Sentence(
    "tensor-not-symmetric", "the tensor is not symmetric: its {entry} entry is {value} and its {mirrored} "
    "entry {other}, they differ by {difference}; write the same number in both places")
NOT_POSITIVE = Sentence(
    "tensor-not-positive", "the tensor is not positive definite: its least principal moment is {least}, and "
    "those of a body are positive; are the products too large, or their sign convention another one?")


def fault_of(rows: Rows) -> Reason | None:
    """What keeps a 3 x 3 tensor of rationals from being symmetric with positive principal moments; None where
    nothing does."""
    for i, j in ((0, 1), (0, 2), (1, 2)):
        if rows[i][j] != rows[j][i]:
            value, other = (Quantity(float(v), digits=ENTRY) for v in (rows[i][j], rows[j][i]))
            return NOT_SYMMETRIC(entry=NAMES[i] + NAMES[j], value=value, mirrored=NAMES[j] + NAMES[i],
                                 other=other, difference=Quantity(float(abs(rows[i][j] - rows[j][i]))))
    polynomial = _characteristic(rows)
    constant, linear, square, _ = polynomial.c
    if not (constant < 0 < linear and square < 0):  # the signs of three positive roots, as all are real
        smallest = float(real_roots(polynomial)[0])
        return NOT_POSITIVE(least=Inertia(smallest))
    return None


def _characteristic(m: Rows) -> Poly:
    from flint import fmpq_mat
    return Poly.of(fmpq_mat([[rational(v) for v in row] for row in m]).charpoly())


def _moments(m: Rows, polynomial: Poly, bits: int) -> tuple[Moment, Moment, Moment]:
    """((moment, whether it is rational and exact), ...) descending, as often as they are repeated; their sum
    is the exact trace."""
    trace = m[0][0] + m[1][1] + m[2][2]
    roots = [(root, polynomial(root) == 0) for root in reversed(real_roots(polynomial, bits))]
    if len(roots) == 3:
        middle = trace - roots[0][0] - roots[2][0]
        return roots[0], (middle, roots[1][1]), roots[2]
    first, second = roots  # one of a cubic's two roots is double, so both are rational
    return (first, first, second) if polynomial.derivative()(first[0]) == 0 else (first, second, second)


def _axes(m: Rows, moments: Sequence[Moment], bits: int) -> PrincipalAxes | None:
    """Axes of these moments with the error they have; None where the moments are not yet separated."""
    values = [value for value, _ in moments]
    if len(set(values)) == 3:
        directions, alone = _three(m, moments, bits), [0, 1, 2]
    else:
        alone = [2] if values[0] == values[1] else [0]
        direction = _column(m, values[alone[0]])
        first, second, third = _with_plane(direction if moments[alone[0]][1] else _rounded(direction, bits))
        directions = [second, third, first] if alone == [2] else [first, second, third]
    if directions is None:
        return None
    axes = _oriented([_unit(direction, bits) for direction in directions])
    error = _error(m, values, axes, alone)
    return error if error is None else PrincipalAxes(tuple(values), axes, not error, error)


def _three(m: Rows, moments: Sequence[Moment], bits: int) -> list[Triple] | None:
    """Three directions. Where one moment is rational its direction is exact and the others exactly across it.
    """
    # the best two; the third is across them
    order = sorted(range(3), key=lambda i: (not moments[i][1], i == 1))
    exact = [moments[i][1] for i in order]
    first, second = (_column(m, moments[i][0]) for i in order[:2])
    if not any(first) or not any(second):
        return None
    if not exact[1]:
        second = _across(first, second, bits) if exact[0] else _rounded(second, bits)
        first = first if exact[0] else _rounded(first, bits)
    result = dict(zip(order, (first, second, cross(first, second))))
    return [result[i] for i in range(3)]


def _across(first: Triple, direction: Triple, bits: int) -> Triple:
    """The direction with two short numbers in the plane across `first`, to which it is exactly orthogonal."""
    _, p, q = _with_plane(first)
    a, b = _rounded((dot(direction, p) / dot(p, p), dot(direction, q) / dot(q, q)), bits)
    return tuple(a * x + b * y for x, y in zip(p, q))


def _rounded(numbers: Sequence[Fraction], bits: int) -> Triple:
    """Multiples of the numbers with so many bits after the point, the largest of size 1."""
    scale = max(map(abs, numbers))
    return tuple(Fraction(round(v / scale * (1 << bits)), 1 << bits) for v in numbers)


def _column(m: Rows, moment: Fraction) -> Triple:
    """The direction that (m - moment I) leaves out: the largest column of its adjugate; zero where two
    moments are alike."""
    a = [[v - (i == j) * moment for j, v in enumerate(row)] for i, row in enumerate(m)]
    adjugate = [cross(a[1], a[2]), cross(a[2], a[0]), cross(a[0], a[1])]  # symmetric
    return adjugate[max(range(3), key=lambda i: abs(adjugate[i][i]))]


def _unit(direction: Triple, bits: int) -> Triple:
    """Scaled to length 1, exactly where that is rational; the scale has so many bits, so that exact zeros and
    angles stay."""
    square = dot(direction, direction)
    length = sqrt_fraction(square, bits)
    if length * length != square:
        length = 1 / _short(1 / length, bits)
    return tuple(v / length for v in direction)


def _short(value: Fraction, bits: int) -> Fraction:
    """A positive number in so many bits."""
    shift = bits - value.numerator.bit_length() + value.denominator.bit_length()
    return Fraction(round(value * Fraction(2) ** shift)) / Fraction(2) ** shift


def _with_plane(direction: Triple) -> tuple[Triple, Triple, Triple]:
    """A direction and two across it and across each other: any do where the moments there are equal."""
    smallest = min(range(3), key=lambda i: (abs(direction[i]), i))
    second = cross(direction, IDENTITY[smallest])
    return direction, second, cross(direction, second)


def _oriented(axes: Sequence[Triple]) -> tuple[Triple, Triple, Triple]:
    """Axes 1 and 3 with their largest component positive, axis 2 so that all are right-handed."""
    first, third = (_positive(axes[0]), _positive(axes[2]))
    second = axes[1] if dot(cross(third, first), axes[1]) > 0 else tuple(-v for v in axes[1])
    return first, second, third


def _positive(axis: Triple) -> Triple:
    return axis if max(axis, key=lambda v: (abs(v), v)) > 0 else tuple(-v for v in axis)


def _error(m: Rows, values: Sequence[Fraction], axes: Sequence[Triple], alone: Sequence[int]
           ) -> Fraction | None:
    """A bound of the errors of the moments that stand alone, of their axes and of all lengths; None where two
    moments are too close for this many bits. Equal ones have any two axes across the third.

    A vector v of length 1 with |m v - D v| = r is within r of a moment, and within 2 r/gap (as an angle) of
    its axis, where gap is the distance from D to the other moments. The lengths differ from 1 by the error of
    their square roots.
    """
    scale = values[0]
    worst = max(abs(dot(axis, axis) - 1) for axis in axes)
    for value, axis in [(values[i], axes[i]) for i in alone]:
        rest = max(abs(dot(row, axis) - value * axis[i]) for i, row in enumerate(m))
        gaps = [abs(value - other) for other in values if other != value]
        if rest and not min(gaps, default=scale) > 8 * rest:
            return None
        worst = max(worst, 2 * rest / scale, 4 * rest / min(gaps, default=scale))
    places = worst.denominator.bit_length() - worst.numerator.bit_length() - 1
    return worst and Fraction(1, 1 << max(0, places))  # rounded up to a power of two

