"""Numbers of certificates read exactly, rates of a gyrostat from them, balls and their precision, and the
zero of a monotone function.

python-flint's precision belongs to the whole process, which may run the analysis in another thread meanwhile.
So whoever needs it holds one lock, and the lock stands on the library: the one thing that checker and
analysis share, and neither has to know the other."""
from __future__ import annotations

import re
import reprlib
from collections.abc import Callable, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from fractions import Fraction
from threading import RLock
from typing import Any

from flint import arb, ctx, fmpq, fmpq_mpoly, fmpq_poly

# --- Exact numbers, brackets and balls as a certificate writes them
# of a whole number, and of an exponent's value: Python's own limit; longer is an attack, not a certificate
MAX_DIGITS = 4300
MAX_ENTRIES = 64  # entries of a list: no scene has nearly as many equilibria, curves, pieces or coefficients
NUMBER = re.compile(r"[-+]?([0-9]+(/[0-9]+)?|([0-9]+\.?[0-9]*|\.[0-9]+)([eE][-+]?[0-9]{1,5})?)")
LINEAR, VERDICT = ("stable", "unstable", "degenerate"), ("stable", "unstable", "undecided")


class Malformed(ValueError):
    """The certificate is not of the form that docs/certificate.md describes."""


def shown(value) -> str:
    """A value for a message: short, without control characters, however long or deep it is."""
    try:
        return f"{reprlib.repr(value):.80}"
    except ValueError:  # a whole number of more digits than Python prints
        return type(value).__name__


def quoted(text: str) -> str:
    """Words of the file that nothing here checks, marked as its own: as one quotation, whose marks cannot be
    closed from within, without control characters."""
    plain = "".join(c for c in text if c.isprintable())
    return f"named in the file: {plain[:80]!r}"


def number(text: str | Sequence[list[str]], where: str) -> Fraction:
    """The exact value of "p/q", an integer or a decimal, in plain digits."""
    if not isinstance(text, str):
        raise Malformed(f"{where}: expected a number as a string, got {shown(text)}")
    _, _, exponent = text.lower().partition("e")
    plain = len(text) <= 2 * MAX_DIGITS + 2 and NUMBER.fullmatch(text)
    if not plain or max(map(len, re.findall("[0-9]+",
                                            text))) > MAX_DIGITS or (exponent and
                                                                   abs(int(exponent)) > MAX_DIGITS):
        raise Malformed(
            f"{where}: expected an integer, a decimal or p/q of at most {MAX_DIGITS} digits, "
            f"got {shown(text)}")
    try:
        return Fraction(text)
    except (ValueError, ZeroDivisionError):
        raise Malformed(f"{where}: expected an integer, a decimal or p/q, got {shown(text)}") from None


def numbers(values, where: str, count: int | None = None) -> list[Fraction]:
    """A list of exact numbers."""
    if not isinstance(values, list) or len(values) > MAX_ENTRIES or (count is not None
                                                                     and len(values) != count):
        raise Malformed(
            f"{where}: expected a list of {count or f'at most {MAX_ENTRIES}'} numbers, got {shown(values)}")
    return [number(v, f"{where}[{i}]") for i, v in enumerate(values)]


def bracket(values: str | Sequence[str], where: str) -> tuple[Fraction, Fraction]:
    """(lo, hi), lo <= hi."""
    low, high = numbers(values, where, 2)
    if low > high:
        raise Malformed(f"{where}: expected a bracket [lo, hi], got lo > hi")
    return low, high


def brackets(values, where: str) -> list[tuple[Fraction, Fraction]]:
    """Three of them."""
    if not isinstance(values, list) or len(values) != 3:
        raise Malformed(f"{where}: expected three brackets, got {shown(values)}")
    return [bracket(ends, f"{where}[{i}]") for i, ends in enumerate(values)]


def whole(value: float, where: str, known: range | Sequence[int]) -> int:
    """One of the whole numbers that are known (a range, or a tuple); truth values are none."""
    if type(value) is not int or value not in known:
        text = f"{known[0]} to {known[-1]}" if isinstance(known, range) else ", ".join(map(str, known))
        raise Malformed(f"{where}: expected a whole number, {text}; got {shown(value)}")
    return value


def optional(table: dict, key: str, read):
    """What is read of table[key]; None where it is missing or null."""
    value = table.get(key)
    return None if value is None else read(value)


def field(table, key: str, where: str, kind=None):
    """table[key], of a given type."""
    if not isinstance(table, dict) or key not in table:
        raise Malformed(f"{where}: {key} is missing")
    if kind is not None and not isinstance(table[key], kind):
        raise Malformed(f"{where}.{key}: expected {getattr(kind, '__name__', kind)}, got {shown(table[key])}")
    return table[key]


def word(table: Mapping[str, Any] | int | None, key: str, where: str, resolved: tuple) -> str:
    """table[key], one of the words that are known."""
    value = field(table, key, where)
    if not isinstance(value, str) or value not in resolved:
        raise Malformed(f"{where}.{key}: expected one of {', '.join(resolved)}, got {shown(value)}")
    return value


def entries(table: Mapping[str, Any], key: str, where: str) -> list:
    """table[key], a list; [] where it is missing or null."""
    if isinstance(table, dict) and table.get(key) is None:
        return []
    if len(field(table, key, where, list)) > MAX_ENTRIES:
        raise Malformed(f"{where}.{key}: expected at most {MAX_ENTRIES} entries, got {len(table[key])}")
    return table[key]


def brief(value: Fraction) -> str:
    """A number of any size in nine digits."""
    try:
        return f"{float(value):.9g}"
    except OverflowError:
        return ball(value).str(9, radius=False)


def q(value: Fraction):
    """flint's rational."""
    value = Fraction(value)
    return fmpq(value.numerator, value.denominator)


def fraction(value: fmpq) -> Fraction:
    """The same number as Python's fraction."""
    return Fraction(int(value.p), int(value.q))


def ball(value):
    """The ball of an exact number at the working precision."""
    return arb(q(value))


def hull(low: Fraction, high: Fraction):
    """The ball that holds [low, high]."""
    return ball(low).union(ball(high))


def sign(value: arb) -> int | None:
    """Sign of a ball; None where it is open."""
    return 1 if value > 0 else -1 if value < 0 else 0 if value.is_zero() else None


def exact_sign(value: Fraction | fmpq) -> int:
    """Sign of a rational."""
    return (value > 0) - (value < 0)


@contextmanager
def working(bits: int):
    """Context in which python-flint works with so many bits, for this thread alone."""
    import flint
    with vars(flint).setdefault("stabilab_lock", RLock()), flint.ctx.workprec(bits):
        yield


# --- The zero of a function on an interval where it is monotone
SPLIT = Fraction(489, 1000)  # off the middle: a zero is less often where an interval is cut


class Open(Exception):
    """Not decided at this precision."""


def narrowed(f: Callable[[arb], arb], df: Callable[[arb], arb], a: Fraction, b: Fraction):
    """The ball of the one zero of a function that is monotone on [a, b] and changes sign there: interval
    Newton."""
    x = hull(a, b)
    for _ in range(4 * ctx.prec.bit_length() + 40):
        centre = x.mid()
        slope = df(x)
        if not sign(slope):
            return _bisected(f, df, a, b)
        new = centre - f(centre) / slope
        if not new.overlaps(x):
            raise Open
        new = new.intersection(x)
        if not new.rad() < x.rad() * 0.9:
            return new
        x = new
    return x


def _bisected(f: Callable[[arb], arb], df: Callable[[arb], arb], a: Fraction, b: Fraction):
    """Halve the bracket until Newton's step may be tried again."""
    left = sign(f(ball(a)))
    for _ in range(2000):
        c = a + (b - a) * SPLIT
        middle = sign(f(ball(c)))
        if not left or not middle:
            raise Open
        a, b = (c, b) if middle == left else (a, c)
        if sign(df(hull(a, b))):
            return narrowed(f, df, a, b)
    raise Open


def below(value: arb) -> Fraction:
    """The lower end of a ball, exactly."""
    return _exact(value.mid()) - _exact(value.rad())


def above(value: arb) -> Fraction:
    """The upper end of a ball, exactly."""
    return _exact(value.mid()) + _exact(value.rad())


def _exact(value: arb) -> Fraction:
    """An exact ball as a fraction."""
    value = value.mid() if value.is_exact() else value.upper()
    mantissa, exponent = (int(v) for v in value.man_exp())
    return Fraction(mantissa) * Fraction(2) ** exponent


# --- The rates of the three components, from the numbers of a scene: x_i' = kappa x_j x_k + rho x_k + sigma
# x_j + m
AHEAD = ((1, 2), (2, 0), (0, 1))


@dataclass(frozen=True)
class Rates:
    """Coefficients (each a list of three fractions), and two affine conditions (normal, constant) that every
    equilibrium meets: normal . x + constant = 0. torque: whether any component of it acts. integrals: two
    functions sum (a_i x_i^2/2 + b_i x_i), each as (a, b), whose rates along the motion are these
    conditions."""

    kappa: list
    rho: list
    sigma: list
    m: list
    conditions: tuple
    torque: bool
    integrals: tuple
    parallel: tuple | None = None  # (D, lambda) of a body: without torque D x + lambda is parallel to x

    @classmethod
    def of_scene(cls, scene: Mapping[str, Any]) -> Rates:
        """The rates of the certificate's scene."""
        kind = field(scene, "variables", "scene", str)
        if kind == "physical":
            rows = [numbers(field(scene, key, "scene"), f"scene.{key}", 3)
                    for key in ("inertia", "momentum", "torque")]
            if min(rows[0]) <= 0:
                raise Malformed("scene.inertia: expected positive moments")
        elif kind == "scaled":
            rows = [[number(field(scene, key, "scene"), f"scene.{key}")] for key in "ab"]
            rows.append(numbers(field(scene, "mu", "scene"), "scene.mu", 3))
        else:
            raise Malformed(f"scene.variables: expected 'physical' or 'scaled', got {kind!r}")
        return cls.of(kind, *rows)

    @classmethod
    def of(cls, variables: str, first: Sequence[Fraction], second: Sequence[Fraction],
           torque: Sequence[Fraction]) -> Rates:
        """Those of `written_out`, over their weights."""
        weights, *terms, conditions, integrals = written_out(variables, first, second, torque)
        kappa, rho, sigma, m = ([c / w for c, w in zip(row, weights)] for row in terms)
        return cls(kappa, rho, sigma, m, conditions, any(torque), integrals,
                   (first, second) if variables == "physical" else None)

    def at(self, x, w=1):
        """The rates at x/w, times w^2: fractions, balls or polynomials alike."""
        kappa, rho, sigma, m = self._lifted(x)
        return [kappa[i] * x[j] * x[k] + (rho[i] * x[k] + sigma[i] * x[j]) * w + m[i] * w * w
                for i, (j, k) in enumerate(AHEAD)]

    def jacobian(self, x, w=1):
        """Rows of derivatives of the rates at x/w, times w."""
        kappa, rho, sigma, _ = self._lifted(x)
        rows = [[x[0] * 0] * 3 for _ in AHEAD]
        for i, (j, k) in enumerate(AHEAD):
            rows[i][j], rows[i][k] = kappa[i] * x[k] + sigma[i] * w, kappa[i] * x[j] + rho[i] * w
        return rows

    def _lifted(self, x):
        """The coefficients in the arithmetic of x."""
        lift = q if isinstance(x[0], (fmpq_poly, fmpq_mpoly)) else ball if isinstance(x[0], arb) else Fraction
        return [[lift(v) for v in row] for row in (self.kappa, self.rho, self.sigma, self.m)]


def written_out(variables: str, first, second, torque) -> tuple:
    """(w, kappa, rho, sigma, m, conditions, integrals) of w_i x_i' = kappa_i x_j x_k + rho_i x_k + sigma_i
    x_j + m_i, the last two as of `Rates`. first, second: moments and momentum of a body, D x' = (D x +
    lambda) x x + M; [a] and [b] of the scaled system x1' = x2 x3 + mu1, x2' = -x3 (x1 + a) + mu2, x3' = x2
    (x1 + b) + mu3. Of numbers of any kind."""
    o = 0 * torque[0]
    item = o + 1
    if variables == "scaled":
        (a,), (b,), mu = first, second, torque
        conditions = ([mu[0], mu[1], o], mu[0] * a), ([mu[0], o, -mu[2]], mu[0] * b)
        integrals = ([item, item, o], [a, o, o]), ([item, o, -item], [b, o, o])
        return [item] * 3, [item, -item, item], [o, o, b], [o, -a, o], mu, conditions, integrals
    D, lam = first, second
    times = lambda v: [d * c for d, c in zip(D, v)]
    conditions = (torque, o), (times(torque), sum((l * t for l, t in zip(lam, torque)), o))
    integrals = (D, [o] * 3), (times(D), times(lam))
    return (D, [D[j] - D[k] for j, k in AHEAD], [lam[j] for j, _ in AHEAD], [-lam[k] for _, k in AHEAD],
            torque, conditions, integrals)


def characteristic(J):
    """(m, n) of z^3 + m z + n for a matrix with zero diagonal."""
    m = -(J[0][1] * J[1][0] + J[0][2] * J[2][0] + J[1][2] * J[2][1])
    n = -(J[0][1] * J[1][2] * J[2][0] + J[0][2] * J[1][0] * J[2][1])
    return m, n


def excluded(rates, box) -> bool:
    """Whether a rate has one sign all over the box."""
    return any(sign(v) in (1, -1) for v in rates.at([hull(a, b) for a, b in box]))


