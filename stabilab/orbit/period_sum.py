"""The period of a motion between two turning points as a sum over equal steps, with a proved remainder.

The offset y = M(x) is a fraction of first degree in x that takes -1 and 1 to the turning points, and x(v) one
of Jacobi's functions cd and cn, of period 4 K in v. So

    period = integral over 4 K of g dv,    g = |dy/dv| / W(y),

where g is even and periodic, and no root at a turning point is left. The modulus and M put one more pair of
zeros of W^2 (two real ones beyond the turning points, or two conjugate ones) where x(v) has its branch
points: next to a separatrix the pair pinches the motion, and the steps grow with the logarithm of its
distance, not with its inverse root.

Of a function that is analytic and at most M in size for |Im v| <= b the sum of n terms over a period L is off
by at most

    2 M L / (exp(2 pi b n/L) - 1)

(Trefethen and Weideman, SIAM Review 56, 2014, theorem 3.2). Both are proved in balls on the image of Im v = b
alone: W^2 goes round zero there twice, so that the turning points are its only zeros inside, and g^2 =
y'^2/W^2, which has neither zeros nor poles inside, is largest on it."""
from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from time import perf_counter
from typing import TYPE_CHECKING, Any, NamedTuple

from ..numbers.balls import Unclear, working
from .one_orbit import BallConic

if TYPE_CHECKING:
    from flint import acb, arb

WIDEST = 3.0  # half-width of a strip in quarter periods, where no pair of zeros limits it
PARTS = 0.99, 0.5, 0.2, 0.05, 0.01, 0.001, 2.0**-14  # of it, that are tried first
POINTS = 16, 96  # of the boundary, in the search for the widest strip; more where the first find none
HALVINGS = 2, 7  # of its height, where few terms are wanted and where many are
# (part of that height, pieces of the boundary) that are tried for a proof: few pieces where few terms are
# wanted, high ones where many are
QUICK = (0.75, 24), (0.6, 96), (0.5, 384), (0.4, 1024)
CLOSE = (0.95, 192), (0.85, 192), (0.7, 384), (0.4, 1024)
ENOUGH = 0.4  # height in quarter periods of a strip that serves few digits
FEW_BITS = 1200
PLAN_BITS = 192, 1024  # of the choice and the proof
CONSTANT_BITS = 160  # of a substitution
MAX_NODES = 1 << 20
TIMED = range(4, 12)  # terms whose time says that of all
SPARE_BITS = 8  # by which the remainder is smaller than what is asked for


class Jacobi(NamedTuple):
    """sn, cn and dn at one place; balls."""

    s: Any
    c: Any
    d: Any


@dataclass(frozen=True)
class Substitution:
    """y = middle + half (x + beta)/(1 + beta x), x = cd(v) or (pair of conjugate zeros) cn(v) of the
    complementary parameter m1; exact numbers but for the turning points."""

    beta: Any
    m1: Any
    conjugate: bool

    def quarter(self) -> tuple[arb, arb]:
        """K and K'; K' is infinite for circular functions."""
        from flint import arb
        half = arb.pi() / 2
        m = 1 - self.m1
        root = self.m1.sqrt()
        return half / root.agm(arb(1)), half / m.sqrt().agm(arb(1)) if m > 0 else arb("inf")

    def functions(self, part: arb) -> Jacobi:
        """sn, cn, dn at part K, 0 <= part <= 2."""
        from flint import acb, arb
        if self.m1 == 1:
            s, c = (part * arb.pi() / 2).sin_cos()
            return Jacobi(s, c, arb(1))
        whole, across = self.quarter()
        tau = acb(0, across / whole)
        _, two, three, four = (v.real for v in acb.modular_theta(acb(0), tau))
        first, second, third, fourth = (v.real for v in acb.modular_theta(acb(part / 2), tau))
        return Jacobi(three / two * first / fourth, four / two * second / fourth,
                      four / three * third / fourth)

    def added(self, one: Jacobi, two: Jacobi) -> Jacobi:
        """The functions of the sum of two real arguments."""
        m = 1 - self.m1
        a, b = one.s * two.s, one.d * two.d
        below = 1 / (1 - m * a * a)
        return Jacobi((one.s * two.c * two.d + two.s * one.c * one.d) * below,
                      (one.c * two.c - a * b) * below, (b - m * a * one.c * two.c) * below)

    def inside(self, at: Jacobi) -> tuple[Any, Any]:
        """(x, its slope) there."""
        if self.conjugate:
            return at.c, at.s * at.d
        return at.c / at.d, self.m1 * at.s / (at.d * at.d)

    def above(self, at: Jacobi, high: Jacobi) -> Jacobi:
        """The functions at v + i b; high: those of b of the parameter m1."""
        from flint import acb
        m = 1 - self.m1
        below = high.c * high.c + m * (at.s * high.s) ** 2
        return Jacobi(acb(at.s * high.d, at.c * at.d * high.s * high.c) / below,
                      acb(at.c * high.c, -at.s * at.d * high.s * high.d) / below,
                      acb(at.d * high.c * high.d, -m * at.s * at.c * high.s) / below)


class _Motion:
    """Between two turning points of an orbit: y of x, and W^2 of y."""

    def __init__(self, orbit: BallConic, left: arb, right: arb) -> None:
        self.orbit, self.middle, self.half = orbit, (left + right) / 2, (right - left) / 2

    def speed(self, y: Any) -> Any:
        """W^2."""
        orbit = self.orbit
        x, z = orbit.place(y)
        return (2 * orbit.energy + 2 * orbit.mu * y + (x - orbit.x) * (orbit.G * (x + orbit.x) + 2 * orbit.c)
                + 2 * orbit.r.e * orbit.d * (z - orbit.z))

    def offset(self, by: Substitution, x: Any) -> tuple[Any, Any]:
        """(y, dy/dx)."""
        below = 1 / (1 + by.beta * x)
        return (self.middle + self.half * (x + by.beta) * below,
                self.half * (1 - by.beta * by.beta) * below * below)

    def time(self, by: Substitution, x: arb, slope: arb) -> arb:
        """g."""
        y, rate = self.offset(by, x)
        speed = self.speed(y)
        if not speed > 0:
            raise Unclear
        return slope * rate / speed.sqrt()


@dataclass(frozen=True)
class Plan:
    """A substitution and what is proved of it: |g| <= largest for |Im v| <= height."""

    by: Substitution
    height: Any
    largest: Any
    quarter: Any

    def nodes(self, bits: int) -> int:
        """Even number of terms on half a period for a remainder of 2^-bits of the period, roughly."""
        scale = float((8 * self.largest * self.quarter).mid().log()) / math.log(2)
        rate = float((self.height * math.pi / self.quarter).mid()) / math.log(2)  # bits a term
        return 2 * math.ceil((bits + max(scale, 0.0) + SPARE_BITS) / rate / 2)

    def remainder(self, nodes: int) -> arb:
        """Bound of the remainder of so many terms on half a period."""
        from flint import arb
        grown = (arb.pi() * self.height * nodes / self.quarter).exp() - 1
        return (8 * self.largest * self.quarter / grown).abs_upper()


def plan(orbit: BallConic, left: arb, right: arb, bits: int) -> Plan | None:
    """The substitution that needs the fewest terms for so many bits, of those that pairs of zeros beside
    equilibria suggest; None where nothing is proved of any."""
    for many in PLAN_BITS:
        with working(min(many, bits)):
            result = _plan(_Motion(orbit, left, right), bits)
        if result is not None or many >= bits:
            return result
    return None


def _plan(motion: _Motion, bits: int) -> Plan | None:
    best: tuple[arb, _Strip] | None = None
    for by in _substitutions(motion):
        strip = _Strip(motion, by)
        height = strip.reach(HALVINGS[bits > FEW_BITS])
        if height is not None and (best is None or height / strip.quarter > best[0] / best[1].quarter):
            best = height, strip
            if bits <= FEW_BITS and height > ENOUGH * strip.quarter:
                break
    if best is None:
        return None
    height, strip = best
    for part, pieces in QUICK if bits <= FEW_BITS else CLOSE:
        largest = strip.bound((part * height).mid(), pieces)
        if largest is not None:
            return Plan(strip.by, (part * height).mid(), largest, strip.quarter)
    return None


def summed(orbit: BallConic, left: arb, right: arb, by: Plan, nodes: int,
           tell: Callable[[float], None] | None = None) -> arb:
    """The period by so many terms on half a period. tell: is given the seconds that they take, by the first
    ones."""
    from flint import arb
    motion, total = _Motion(orbit, left, right), arb(0)
    begun = 0.0
    for n, at in enumerate(_nodes(by.by, nodes)):
        if n == TIMED.start:  # the first ones compute constants that the library keeps
            begun = perf_counter()
        elif n == TIMED.stop and tell is not None:
            tell((perf_counter() - begun) * nodes / (2 * len(TIMED)))
        x, slope = by.by.inside(at)
        total += motion.time(by.by, x, slope) + motion.time(by.by, -x, slope)
    quarter, _ = by.by.quarter()
    return 4 * quarter / nodes * total + arb(0, by.remainder(nodes))


def _nodes(by: Substitution, nodes: int) -> Iterator[Jacobi]:
    """The functions at (j + 1/2) 2 K/nodes up to K."""
    from flint import arb
    at, step = by.functions(arb(1) / nodes), by.functions(arb(2) / nodes)
    for _ in range(nodes // 2):
        yield at
        at = by.added(at, step)


# --- Which pair of zeros
def _substitutions(motion: _Motion) -> list[Substitution]:
    """Circular functions, and those of pairs of zeros beside the equilibria, the nearest pairs last."""
    from flint import acb, arb
    orbit, result = motion.orbit, [Substitution(arb(0), arb(1), False)]
    beyond: list[Any] = [[], []]
    for spot in orbit.all_spots:
        slope, speed = orbit.slope(spot.y), motion.speed(spot.y)
        if not slope > 0:
            continue
        square = ((speed / slope).mid()) / motion.half**2
        w = (spot.y - motion.middle) / motion.half
        if -1 < w < 1:
            if square > 0:
                result.append(_of_conjugate(acb(w.mid(), square.mid().sqrt())))
        elif abs(w) > 1 and not square > 0:
            outer = w + (1 if w > 0 else -1) * (-square).mid().sqrt()
            beyond[w > 0].append(outer.mid())
    low = min(beyond[0], key=abs, default=None)
    high = min(beyond[1], key=abs, default=None)
    for pair in ((low, high), (low, None), (None, high)):
        zeros = [v for v in pair if v is not None]
        if zeros and (len(zeros) == 2 or pair != (low, high)):
            result.append(_of_real(*zeros))
    return [by for by in result if by is not None]


def _of_conjugate(w: acb) -> Substitution | None:
    """For the zeros w and its conjugate, -1 and 1 the turning points."""
    from flint import arb
    beta = arb(0)
    if w.real != 0:
        far = (1 + abs(w) ** 2) / w.real
        beta = _small_root(far)
    if beta is None:
        return None
    size = abs((w - beta) / (1 - beta * w)).mid()
    m1 = _exact(size * size / (1 + size * size))
    return Substitution(_exact(beta), m1, True) if 0 < m1 < 1 else None


def _of_real(first: arb, second: arb | None = None) -> Substitution | None:
    """For real zeros beyond the turning points -1 and 1; the second at infinity where there is none."""
    from flint import arb
    if second is None:
        beta = _small_root(2 * first)
    elif (first + second).mid() == 0:
        beta = arb(0)
    else:
        beta = _small_root(2 * (1 + first * second) / (first + second))
    if beta is None:
        return None
    size = abs((first - beta) / (1 - beta * first)).mid()
    m1 = _exact((size - 1) * (size + 1) / size**2)
    return Substitution(_exact(beta), m1, False) if 0 < m1 < 1 else None


def _small_root(twice: arb) -> arb | None:
    """The root of t^2 - twice t + 1 below one in size."""
    inside = (twice / 2) ** 2 - 1
    if not inside > 0:
        return None
    side = 1 if twice > 0 else -1
    return (1 / (twice / 2 + side * inside.sqrt())).mid()


def _exact(ball: arb) -> arb:
    """Near it, with few bits: multiplying by it costs little."""
    from flint import arb, fmpz
    middle, power = ball.mid().man_exp()
    many = max(0, int(middle).bit_length() - CONSTANT_BITS)
    return arb(fmpz(int(middle) >> many)) * arb(2) ** (int(power) + many)


# --- What is proved of it
class _Strip:
    """The image of the line Im v = b in the plane of y."""

    def __init__(self, motion: _Motion, by: Substitution) -> None:
        self.motion, self.by = motion, by
        self.quarter, self.across = by.quarter()

    def reach(self, halvings: int) -> arb | None:
        """The widest strip that no zero seems to limit, by the turns of W^2 between a few points; no proof.
        """
        limit = WIDEST * self.quarter
        high = self.across.min(limit) if self.across.is_finite() else limit
        points, low, beyond = list(self._along(POINTS[0])), PARTS[0], 1.0
        while not self._turns(points, (low * high).mid()):
            if low > PARTS[-1]:
                low, beyond = next(part for part in PARTS if part < low), low
            elif len(points) > POINTS[0] + 1:
                return None
            else:
                points, low, beyond = list(self._along(POINTS[1])), PARTS[0], 1.0
        for _ in range(halvings if beyond < 1 else 0):
            middle = (low + beyond) / 2
            low, beyond = (middle, beyond) if self._turns(points, (middle * high).mid()) else (low, middle)
        return (low * high).mid()

    def bound(self, height: arb, pieces: int) -> arb | None:
        """A bound of |g| in the strip of this height; None where it is not proved that there is one."""
        from flint import acb, arb
        motion, by, up = self.motion, self.by, self._high(height)
        reach = self.quarter / pieces  # half a piece
        wide, growth = arb(0, reach.abs_upper()), reach.exp() - 1
        points, turned, largest = list(self._along(2 * pieces)), arb(0), arb(0)
        ends = [motion.speed(motion.offset(by, by.inside(by.above(at, up))[0])[0]) for at in points[::2]]
        for middle, before, after in zip(points[1::2], ends, ends[1:]):
            if before.contains(0) or after.contains(0):
                return None
            turned += (after / before).arg()
            # the slopes of sn and cn are dn in size at most, that of dn's logarithm one
            off = arb(0, (middle.d * (1 + growth) * reach).abs_upper())
            around = Jacobi(middle.s + off, middle.c + off,
                            middle.d + arb(0, (middle.d * growth).abs_upper()))
            _, slope = by.inside(by.above(around, up))
            x, _ = by.inside(by.above(middle, up))
            way = slope * acb(wide)
            place, _ = motion.offset(by, x)
            _, rate = motion.offset(by, x + way)
            route = rate * way
            # Taylor's series: terms that nearly cancel would be far wider as one ball
            orbit = motion.orbit
            bend, _ = orbit.bends(place)
            _, last = orbit.bends(place + route)
            curved = orbit.slope(place) + route * (bend / 3 + route * last / 12)
            speed = motion.speed(place) + route * (2 * orbit.force(place) + route * curved)
            if not speed.is_finite() or speed.contains(0):
                return None
            largest = largest.max(arb(((slope * rate) ** 2 / speed).abs_upper()))
        turns = abs(turned) / arb.pi()
        return largest.sqrt() if turns.contains(2) and turns < 2.5 and turns > 1.5 else None

    def _along(self, pieces: int) -> Iterator[Jacobi]:
        """The functions at the ends of equal pieces of half a period."""
        from flint import arb
        at, step = Jacobi(arb(0), arb(1), arb(1)), self.by.functions(arb(2) / pieces)
        for _ in range(pieces + 1):
            yield at
            at = self.by.added(at, step)

    def _high(self, height: arb) -> Jacobi:
        """The functions of the height, of the complementary parameter."""
        from flint import arb
        if self.by.m1 < 1:
            return Substitution(arb(0), 1 - self.by.m1, False).functions(height / self.across)
        grow = height.exp()
        return Jacobi((grow - 1 / grow) / (grow + 1 / grow), 2 / (grow + 1 / grow), 2 / (grow + 1 / grow))

    def _turns(self, points: list[Jacobi], height: arb) -> bool:
        """Whether W^2 seems to go round zero twice."""
        up, turned, before = self._high(height), 0.0, None
        for at in points:
            x, _ = self.by.inside(self.by.above(at, up))
            value = self.motion.speed(self.motion.offset(self.by, x)[0])
            if not value.is_finite() or value.contains(0):
                return False
            turned += float((value / before).arg().mid()) if before is not None else 0.0
            before = value
        return abs(abs(turned) - 2 * math.pi) < 1
