"""Curves of equilibria, rational in a parameter: the rates vanish along them, and m changes sign where it is said to."""
from __future__ import annotations

from fractions import Fraction

from ..numbers import LINEAR, VERDICT, Malformed, bracket, brief, entries, exact_sign, field, fraction, numbers, q, word
from ..rates import AHEAD, characteristic
from ..roots import real_zeros
from .degenerate import drift, leaves_fold, on_common_level, on_own_orbit, reducing_direction

PAIRS = ((0, 1), (0, 2), (1, 2))


class Curve:
    """x_i(t) = numerators[i](t)/denominator(t) with what is said of its pieces; coefficients lowest first."""

    def __init__(self, table, where):
        rows = field(table, "numerators", where, list)
        if len(rows) != 3:
            raise Malformed(f"{where}.numerators: expected three lists of coefficients")
        tops = [numbers(r, f"{where}.numerators[{i}]") for i, r in enumerate(rows)]
        bottom = numbers(field(table, "denominator", where), f"{where}.denominator")
        from flint import fmpq_poly
        self.tops, self.bottom = [fmpq_poly([q(c) for c in row]) for row in tops], fmpq_poly([q(c) for c in bottom])
        if self.bottom == 0:
            raise Malformed(f"{where}.denominator: expected a polynomial that is not zero")
        common = self.bottom
        for top in self.tops:
            common = common.gcd(top)
        self.tops, self.bottom = [top // common for top in self.tops], self.bottom // common
        self.degree = max(p.degree() for p in (*self.tops, self.bottom))
        self.claim = f"{'straight line' if self.straight else f'curve of degree {self.degree}'} ({where})"
        self.segments = [_piece(s, f"{where}.segments[{i}]") for i, s in enumerate(entries(table, "segments", where))]
        self.folds = [(bracket(field(f, "t", w), f"{w}.t"), *_words(f, w))
                      for i, f in enumerate(entries(table, "folds", where)) for w in [f"{where}.folds[{i}]"]]

    @property
    def straight(self) -> bool:
        """Whether it runs once along a whole straight line; a pole would leave out one point."""
        return self.degree == 1 and self.bottom.degree() == 0

    def at(self, t):
        """The exact point at a rational parameter that is no pole."""
        return [fraction(top(q(t)) / self.bottom(q(t))) for top in self.tops]


def curve_of(table, where) -> Curve:
    """A claimed curve."""
    return Curve(table, where)


def _piece(table, where):
    ends = field(table, "t", where, list)
    if len(ends) != 2:
        raise Malformed(f"{where}.t: expected two ends")
    ends = [None if e is None else bracket(e, f"{where}.t[{i}]") for i, e in enumerate(ends)]
    return ends, *_words(table, where)


def _words(table, where):
    return word(table, "linear", where, LINEAR), word(table, "verdict", where, VERDICT)


def identically_zero(rates, curve) -> bool:
    """Whether the rates, times the square of the denominator, vanish as polynomials."""
    x, d = curve.tops, curve.bottom
    return all(q(rates.kappa[i]) * x[j] * x[k] + q(rates.rho[i]) * x[k] * d + q(rates.sigma[i]) * x[j] * d
               + q(rates.m[i]) * d * d == 0 for i, (j, k) in enumerate(AHEAD))


def _homogeneous_jacobian(rates, curve):
    """The Jacobian along the curve, times the denominator."""
    x, d = curve.tops, curve.bottom
    zero, rows = d - d, []
    for i, (j, k) in enumerate(AHEAD):
        row = [zero] * 3
        row[j] = q(rates.kappa[i]) * x[k] + q(rates.sigma[i]) * d
        row[k] = q(rates.kappa[i]) * x[j] + q(rates.rho[i]) * d
        rows.append(row)
    return rows


def check_curve(rates, curve, note):
    """Findings on the verdicts along a curve on which the rates vanish."""
    note(curve.claim, "proved", "the rates vanish identically along it")
    J = _homogeneous_jacobian(rates, curve)
    m, n = characteristic(J)
    if n != 0 or m == 0:
        note(f"{curve.claim}: verdicts", "refuted" if n != 0 else "not checked",
             "the Jacobian's determinant does not vanish along it" if n != 0 else "three zero eigenvalues all along")
        return
    pole = lambda z: curve.bottom % z.factor == 0
    marks = real_zeros(m * curve.bottom)
    inner = [z for z in marks if not pole(z)]
    if len(curve.segments) != len(marks) + 1 or len(curve.folds) != len(inner):
        note(curve.claim, "refuted", f"m has {len(inner)} zeros and the curve {len(marks) - len(inner)} poles: {len(marks) + 1} pieces "
                                     f"and {len(inner)} folds, not {len(curve.segments)} and {len(curve.folds)}")
        return
    along = _Along(rates, curve, J, m)
    bounds = [None, *marks, None]
    signs = [_sign_between(m, low, high) for low, high in zip(bounds, bounds[1:])]
    for number, (piece, sign) in enumerate(zip(curve.segments, signs)):
        _check_piece(along, note, f"{curve.claim}: piece {number + 1}", piece, bounds[number:number + 2], sign)
    for zero, fold in zip(inner, curve.folds):
        number = marks.index(zero)
        _check_fold(along, note, zero, fold, signs[number:number + 2])


def _check_piece(along, note, where, piece, bounds, sign):
    ends, linear, verdict = piece
    claim = f"{where}: linear {linear}, verdict {verdict}"
    if not all(_agrees(end, mark) for end, mark in zip(ends, bounds)):
        note(claim, "refuted", "its ends are not the zeros of m and the poles beside it")
    elif linear != ("stable" if sign > 0 else "unstable"):
        note(claim, "refuted", f"m is {'positive' if sign > 0 else 'negative'} on it")
    else:
        proof = along.centre(bounds) if sign > 0 else ("unstable", "m < 0")
        note(claim, *judged(verdict, proof, "a centre on a line of equilibria"))


def _check_fold(along, note, zero, fold, signs):
    ends, linear, verdict = fold
    claim = f"{along.curve.claim}: fold near t = {brief((zero.low + zero.high) / 2)}: linear {linear}, verdict {verdict}"
    if not _agrees(ends, zero) or linear != "degenerate":
        note(claim, "refuted", "m vanishes elsewhere, or does vanish here")
    else:
        note(claim, *judged(verdict, along.fold(zero, signs), "three zero eigenvalues"))


def judged(verdict, proof, otherwise):
    """(status, reason) of a claimed verdict, given (verdict, reason) or None."""
    if proof is None:
        return "not checked", f"{otherwise}: no proof is known here"
    if verdict == "undecided":
        return "not checked", f"the certificate leaves open what is proved: {proof[0]}: {proof[1]}"
    return ("proved" if verdict == proof[0] else "refuted"), proof[1]


class _Along:
    """What decides stability along one curve: the integrals without a torque, a reduction, or the drift along the line."""

    def __init__(self, rates, curve, J, m):
        self.rates, self.curve, self.J, self.m = rates, curve, J, m
        self.direction = reducing_direction(rates, curve) if rates.torque else None
        self.settled = not rates.torque or self.direction is not None

    def centre(self, bounds):
        """The verdict between two marks where m > 0."""
        if self.settled:
            return "stable", "m > 0: a strict extremum"
        low, high = bounds
        k = drift(self.rates, self.J, self.m) if self.curve.straight else 0
        others = [z for z in real_zeros(k) if self.m % z.factor != 0] if k != 0 else []  # those of m bound the piece
        if k == 0 or any((low is None or low.before(z)) and (high is None or z.before(high)) for z in others):
            return None
        return "unstable", "a slow drift along the line of equilibria, of one sense all along the piece"

    def fold(self, zero, signs):
        """The verdict at a zero of m between pieces with these signs of m."""
        minors = [self.J[a][c] * self.J[b][d] - self.J[a][d] * self.J[b][c] for a, b in PAIRS for c, d in PAIRS]
        if all(v % zero.factor == 0 for v in minors):
            return self._crossing(zero)
        if self.settled:
            both = signs == [1, 1]
            return "stable" if both else "unstable", f"m is {'' if both else 'not '}positive on both sides"
        return leaves_fold(self.J, zero) if self.curve.straight else None

    def _crossing(self, zero):
        if zero.low != zero.high:
            return None
        x = self.curve.at(zero.low)
        if not self.rates.torque:
            return on_common_level(self.rates, x)
        return on_own_orbit(self.rates, x, self.direction) if self.direction else None

def _agrees(end, mark) -> bool:
    """Whether a claimed end (None: infinity) holds the zero that was found."""
    if end is None or mark is None:
        return end is None and mark is None
    return mark.within(*end)


def _sign_between(m, low, high) -> int:
    """Sign of m between two neighbouring marks (None: infinity)."""
    if low is None or high is None:
        t = Fraction(0) if low is high else high.low - 1 if low is None else low.high + 1
    else:
        t = (low.high + high.low) / 2
    return exact_sign(m(q(t)))
