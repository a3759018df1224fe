"""Balls: numbers that surely hold the true value, by python-flint, in as many digits as a question needs.

The kind of ball is a value: a question takes it as its argument and hands it on to whatever computes. One
that the balls leave open raises `Unclear`, and `settled` asks it again with twice the bits.
"""
from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from fractions import Fraction
from threading import RLock
from typing import TYPE_CHECKING, Any, TypeVar

from .vectors import Number

if TYPE_CHECKING:
    from flint import arb, fmpq, fmpq_mpoly, fmpq_poly

T = TypeVar("T")
DOUBLE_BITS = 53
MANY_BITS = 320  # of what is formed with many digits to spare
FIRST_BITS = 64  # of a first try, which settles ordinary motions
START_BITS = 128
PARTED_BITS = 1 << 14  # of a place between two roots: for any of numbers that are doubles
NARROWINGS = 60  # of a ball about a root, at most
GUARD_BITS = 32  # beyond what a question is known to lose
MOST_OF_DOUBLES = 1 << 17  # of a question of doubles
APART_BITS = 256  # roots that so many bits do not tell apart would cost flint's iteration a long time


class Unclear(Exception):
    """The balls overlap at this precision."""


@contextmanager
def working(bits: int, terms: int = 10) -> Iterator[Digits]:
    """Context in which python-flint works with so many bits, for this thread alone; gives the kind of number,
    `Digits`. terms: of a power series, at the most; flint leaves out what lies beyond without a word.

    flint's precision belongs to the process: whoever forms balls from inexact ones holds the one lock that
    goes with it. It stands on the library itself, where the checker of certificates, which imports nothing
    from here, finds it too.
    """
    import flint
    with vars(flint).setdefault("stabilab_lock", RLock()), flint.ctx.workprec(bits):
        before, flint.ctx.cap = flint.ctx.cap, terms
        try:
            yield Digits(bits)
        finally:
            flint.ctx.cap = before


@dataclass(frozen=True)
class Digits:
    """Where python-flint's balls come from, to be used while it is `working` with so many bits."""

    bits: int

    @staticmethod
    def ball(value: Number) -> arb:
        from flint import arb
        return arb(rational(Fraction(value)))

    @staticmethod
    def pi() -> arb:
        from flint import arb
        return arb.pi()

    @staticmethod
    def around(middle: arb, width: arb) -> arb:
        """The ball about the middle of one, as wide as `width` can be."""
        from flint import arb
        return arb(middle.mid(), width.abs_upper())

    @staticmethod
    def upper(value: arb) -> arb:
        from flint import arb
        return arb(value.abs_upper())

    @staticmethod
    def lower(value: arb) -> arb:
        from flint import arb
        return arb(value.abs_lower())

    @staticmethod
    def angle(y: arb, x: arb) -> arb:
        """atan2(y, x)."""
        from flint import arb
        return arb.atan2(y, x) if not (0 in y and not x > 0) else arb.pi() + arb.atan2(-y, -x)

    @staticmethod
    def elliptic(n: arb, m: arb) -> tuple[arb, arb]:
        """The complete elliptic integrals K(m) and Pi(n, m) of a parameter 0 <= m < 1 and n < 1.

        By Gauss's arithmetic-geometric mean, whose digits double with every step (DLMF 19.8.6, 19.8.7):
        Pi = pi/(4 agm(1, k')) (2 + n/(1 - n) sum Q), Q_0 = 1, Q_(i+1) = Q_i (p^2 - a g)/(2 (p^2 + a g)). The
        sum's tail is at most its last term, for every next one is half of it or less.
        """
        from flint import arb, ctx
        if not (m >= 0 and m < 1 and n < 1):
            raise Unclear
        a, g, p, term, total = arb(1), (1 - m).sqrt(), (1 - n).sqrt(), arb(1), arb(1)
        while not abs(term) < arb(2) ** -ctx.prec:
            square, product = p * p, a * g
            term = term * (square - product) / (square + product) / 2
            a, g, p, total = (a + g) / 2, product.sqrt(), (square + product) / (2 * p), total + term
            if not term.is_finite() or a.rel_accuracy_bits() < 2:
                raise Unclear
        full = arb.pi() / (2 * a.agm(g))
        total += arb(0, term.abs_upper())
        return full, full / 2 * (2 + n / (1 - n) * total)

    @staticmethod
    def real_roots(coefficients: Sequence[Number]) -> list[tuple[arb, int]]:
        """(root, multiplicity) of the real roots of a polynomial with rational coefficients, lowest first;
        certified."""
        return real_roots_of(polynomial(*coefficients))


def settled(question: Callable[[Digits], T], bits: int = START_BITS,
            most: int = MOST_OF_DOUBLES) -> T:
    """question(numbers), with twice the bits as long as it is `Unclear`; the last Unclear when `most` are not
    enough.

    numbers: a `Digits`, with its `bits`. bits: at first.
    """
    while True:
        try:
            with working(bits) as numbers:
                return question(numbers)
        except Unclear:
            if bits >= most:
                raise
            bits *= 2


def rational(value: Number) -> fmpq:
    """A Fraction, or flint's own rational or integer, as flint's rational."""
    from flint import fmpq
    return fmpq(value.numerator, value.denominator) if isinstance(value, Fraction) else fmpq(value)


def real_roots_of(poly: fmpq_poly) -> list[tuple[arb, int]]:
    """(root, multiplicity) of the real roots of flint's polynomial as balls of the working precision, lowest
    first; certified.

    flint finds all complex roots at once by an iteration that halves its error a step where roots nearly
    meet, and starts again with twice the digits until it tells them apart: seconds for a pair 10^-150 apart.
    Such a polynomial goes to Sturm's theorem.
    """
    from flint import arb
    if poly.degree() < 1:
        return []
    if poly.degree() > 1 and not _roots_stand_apart(poly):
        rows = [(ball, many) for factor, many in poly.factor()[1] for ball in _by_sturm(factor)]
    else:
        roots: list[Any] = poly.complex_roots()  # flint's own types leave the multiplicities out
        rows = [(arb(root.real), many) for root, many in roots if root.imag.is_zero()]
    return sorted(rows, key=lambda item: item[0].mid())  # multiplicity by multiplicity so far


def _roots_stand_apart(poly: fmpq_poly) -> bool:
    """Whether `APART_BITS` tell all complex roots apart; a multiple root is never told from itself."""
    from flint import acb_poly, ctx
    with working(max(ctx.prec, APART_BITS)):
        try:
            acb_poly(poly.numer()).roots(maxprec=APART_BITS)
        except ValueError:
            return False
    return True


def _by_sturm(factor: fmpq_poly) -> list[arb]:
    """The real roots of an irreducible polynomial in exact arithmetic, as balls of the working precision."""
    from flint import arb, ctx, fmpq
    if factor.degree() == 1:
        return [arb(-factor[0] / factor[1])]
    chain = [factor, factor.derivative()]
    while chain[-1].degree() > 0:
        rest = -(chain[-2] % chain[-1])
        chain.append(rest / fmpq(rest.numer().content(), rest.denom()))

    def changes(at: fmpq) -> int:
        signs = [value > 0 for f in chain if (value := f(at)) != 0]
        return sum(s != t for s, t in zip(signs, signs[1:]))
    largest = max(map(abs, factor.coeffs()))
    high = 1 + largest / abs(factor.leading_coefficient())  # Cauchy's bound, and that of 1/t
    low = 1 / (1 + largest / abs(factor[0]))
    result, todo = [], [(a, changes(a), b, changes(b)) for a, b in ((-high, -low), (low, high))]
    while todo:
        a, before, b, after = todo.pop()
        many = before - after
        if many == 1:
            a, b = _narrowed(factor, a, b, ctx.prec)
            result.append(arb((a + b) / 2, (b - a) / 2))
        elif many:
            middle = many == 2 and _between_two(factor, a, b) or _middle(a, b)
            between = changes(middle)
            todo += [(a, before, middle, between), (middle, between, b, after)]
    return result


def _between_two(factor: fmpq_poly, a: fmpq, b: fmpq) -> fmpq | None:
    """A place that parts the two roots between a and b, near the root of the derivative; None where that is
    not bracketed, or `PARTED_BITS` do not tell it from both."""
    slope, bits, outside = factor.derivative(), START_BITS, factor(a)
    if slope(a) * slope(b) >= 0:
        return None
    while bits <= PARTED_BITS:
        with working(bits):
            a, b = _narrowed(slope, a, b, bits // 2)
        middle = (a + b) / 2
        if factor(middle) * outside < 0:
            return middle
        bits *= 2
    return None


def _middle(a: fmpq, b: fmpq) -> fmpq:
    """A dyadic number between two of one sign: near the geometric mean while they are far apart."""
    from flint import fmpq
    if a < 0:
        return -_middle(-b, -a)
    if b <= 8 * a:
        return (a + b) / 2
    size = lambda v: int(v.p).bit_length() - int(v.q).bit_length()
    return fmpq(2) ** ((size(a) + size(b)) // 2)


def _narrowed(factor: fmpq_poly, a: fmpq, b: fmpq, bits: int) -> tuple[fmpq, fmpq]:
    """The bracket (a, b) of a simple root to 2**-bits relative, by Newton's step where the slope has a sign.
    """
    from flint import arb, arb_poly
    rising, slope = factor(b) > 0, arb_poly(factor.derivative())
    while (b - a) * 2**bits > min(abs(a), abs(b)):
        middle = _middle(a, b)
        value, rate = factor(middle), slope(arb(a).union(arb(b)))
        first, last = (a, middle) if (value > 0) == rising else (middle, b)
        if not rate.contains(0):
            step = middle - value / rate
            first, last = max(first, step.lower().fmpq()), min(last, step.upper().fmpq())
        if not last - first < b - a:
            return a, b
        a, b = first, last
    return a, b


def narrowed(value: Callable[[arb], arb], slope: Callable[[arb], arb], root: arb) -> arb:
    """A narrower ball about the one zero of a function that a ball holds: Newton's step from its middle, the
    slope that of the whole ball, as long as that narrows it."""
    for _ in range(NARROWINGS):
        middle, rate = root.mid(), slope(root)
        if rate.contains(0):
            return root
        step = middle - value(middle) / rate
        if not step.overlaps(root):
            return root
        before, root = root, step.intersection(root)
        if not root.rad() < before.rad() / 2:
            return root
    return root


def fraction(value: fmpq) -> Fraction:
    """flint's rational as Python's."""
    return Fraction(int(value.p), int(value.q))


def evaluated(f: fmpq_mpoly, at: Sequence[Any]) -> Any:
    """A polynomial at balls, rationals or series of these, one for each of its variables."""
    from flint import arb
    total = arb(0)
    for powers, c in f.to_dict().items():
        term = arb(c)
        for value, power in zip(at, powers):
            for _ in range(power):
                term = term * value
        total = total + term
    return total


def sign(number: Number) -> int:
    """Sign of a ball; Unclear where it holds zero and more."""
    if number > 0:
        return 1
    if number < 0:
        return -1
    if number.is_zero():
        return 0
    raise Unclear

def polynomial(*coefficients: Number) -> fmpq_poly:
    """flint's polynomial with these rational coefficients, lowest power first."""
    from flint import fmpq_poly
    return fmpq_poly([rational(Fraction(c)) for c in coefficients])


def shares_root(first: fmpq_poly, second: fmpq_poly, root: arb) -> bool:
    """Whether the root (a ball that isolates it among those of `first`) is one of `second` as well; flint's
    polynomials."""
    common = first.gcd(second)
    return any(z.overlaps(root) for z, _ in real_roots_of(common))


def sharpened(settled_as: Callable[..., Any], question: Callable[..., Any], digits: int,
              most: int = MOST_OF_DOUBLES) -> Any:
    """The ball of a question, 10^-digits of it wide at most. settled_as: `settled`, or what asks as it does;
    most: bits that are tried, at least.

    A first answer in few bits shows how many of them the question loses, so that many bits are spent once.
    """
    from flint import ctx
    needed, lost = int(digits * 3.3220) + 2, [GUARD_BITS]

    def with_accuracy(bits: int) -> Callable[[Any], Any]:
        def asked(source: Any) -> Any:
            ball = question(source)
            accuracy = ball.rel_accuracy_bits() if ball.is_finite() else 0
            if accuracy < bits:
                raise Unclear
            lost[0] = max(GUARD_BITS, ctx.prec - accuracy + GUARD_BITS // 2)
            return ball
        return asked
    if needed > MANY_BITS:
        settled_as(with_accuracy(START_BITS // 4), START_BITS, most)
    return settled_as(with_accuracy(needed), needed + lost[0], max(most, 4 * (needed + lost[0])))
