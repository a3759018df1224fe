"""Curves of equilibria, rational in a parameter: the rates vanish along them, and m changes sign where it is said to."""
from __future__ import annotations

from fractions import Fraction

from .numbers import Malformed, bracket, entries, exact_sign, field, hull, numbers, q
from .rates import characteristic


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
        self.claim = f"curve {table.get('name', '')!s:.60} ({where})"
        self.segments = [_piece(s, f"{where}.segments[{i}]") for i, s in enumerate(entries(table, "segments", where))]
        self.folds = [(bracket(field(f, "t", w), f"{w}.t"), field(f, "linear", w, str), field(f, "verdict", w, str))
                      for i, f in enumerate(entries(table, "folds", where)) for w in [f"{where}.folds[{i}]"]]

    def at(self, t):
        """The exact point at a rational parameter that is no pole."""
        from flint import fmpq
        value = lambda p: Fraction(int(fmpq(p(q(t))).p), int(fmpq(p(q(t))).q))  # noqa: E731
        return [value(top) / value(self.bottom) for top in self.tops]


def curve_of(table, where) -> Curve:
    """A claimed curve."""
    return Curve(table, where)


def _piece(table, where):
    ends = field(table, "t", where, list)
    if len(ends) != 2:
        raise Malformed(f"{where}.t: expected two ends")
    ends = [None if e is None else bracket(e, f"{where}.t[{i}]") for i, e in enumerate(ends)]
    return ends, field(table, "linear", where, str), field(table, "verdict", where, str)


def identically_zero(rates, curve) -> bool:
    """Whether the rates, times the square of the denominator, vanish as polynomials."""
    from .rates import AHEAD
    x, d = curve.tops, curve.bottom
    return all(q(rates.kappa[i]) * x[j] * x[k] + q(rates.rho[i]) * x[k] * d + q(rates.sigma[i]) * x[j] * d
               + q(rates.m[i]) * d * d == 0 for i, (j, k) in enumerate(AHEAD))


def _homogeneous_jacobian(rates, curve):
    """The Jacobian along the curve, times the denominator."""
    from .rates import AHEAD
    x, d = curve.tops, curve.bottom
    zero, rows = d - d, []
    for i, (j, k) in enumerate(AHEAD):
        row = [zero] * 3
        row[j] = q(rates.kappa[i]) * x[k] + q(rates.sigma[i]) * d
        row[k] = q(rates.kappa[i]) * x[j] + q(rates.rho[i]) * d
        rows.append(row)
    return rows


def check_curve(rates, curve, note, isolated_conic: bool, torque: bool):
    """Findings on the verdicts along a curve on which the rates vanish."""
    note(curve.claim, "proved", "the rates vanish identically along it")
    J = _homogeneous_jacobian(rates, curve)
    m, n = characteristic(J)
    if n != 0:
        note(curve.claim, "refuted", "the Jacobian's determinant does not vanish along it")
        return
    if m == 0:
        _all_degenerate(curve, note)
        return
    zeros, poles = _real_zeros(m), _real_zeros(curve.bottom)
    inner = [(z, k) for z, k in zeros if not any(z.overlaps(p) for p, _ in poles)]
    marks = sorted([z for z, _ in inner] + [p for p, _ in poles], key=lambda z: float(z.mid()))
    if len(curve.segments) != len(marks) + 1 or len(curve.folds) != len(inner):
        note(curve.claim, "refuted", f"m has {len(inner)} zeros and the curve {len(poles)} poles: {len(marks) + 1} pieces and "
                                     f"{len(inner)} folds, not {len(curve.segments)} and {len(curve.folds)}")
        return
    signs = [_sign_between(m, low, high) for low, high in zip([None, *marks], [*marks, None])]
    settled = isolated_conic or not torque
    for number, ((ends, linear, verdict), sign) in enumerate(zip(curve.segments, signs)):
        claim = f"{curve.claim}: piece {number + 1} {linear}, {verdict}"
        if not all(_agrees(end, mark) for end, mark in zip(ends, ([None, *marks][number], [*marks, None][number]))):
            note(claim, "refuted", "its ends are not the zeros of m and the poles beside it")
        elif linear != ("stable" if sign > 0 else "unstable") or (sign < 0 and verdict != "unstable"):
            note(claim, "refuted", f"m is {'positive' if sign > 0 else 'negative'} on it")
        elif sign > 0 and settled and verdict != "stable":
            note(claim, "refuted", "m > 0: a strict extremum")
        else:
            note(claim, "proved" if sign < 0 or settled else "not checked", "sign of m")
    for (z, _), (ends, linear, verdict) in zip(sorted(inner, key=lambda one: float(one[0].mid())), curve.folds):
        _check_fold(rates, curve, note, (z, marks, signs), (ends, linear, verdict), settled)


def _check_fold(rates, curve, note, place, said, settled):
    (z, marks, signs), (ends, linear, verdict) = place, said
    claim = f"{curve.claim}: fold near t = {float(z.mid()):.9g} {linear}, {verdict}"
    number = next(i for i, mark in enumerate(marks) if mark is z)
    both = signs[number] > 0 and signs[number + 1] > 0
    if not _agrees(ends, z) or linear != "degenerate":
        note(claim, "refuted", "m vanishes elsewhere, or does vanish here")
    elif not rates.torque and ends[0] == ends[1] and rates.parallel and not any(curve.at(ends[0])):
        note(claim, "proved" if verdict == "stable" else "refuted", "at rest without a torque: the energy is definite and constant")
    elif not settled or _crosses(rates, curve, ends):
        note(claim, "not checked", "curves of equilibria cross here, or the torque is oblique")
    else:
        true = "stable" if both else "unstable"
        note(claim, "proved" if verdict == true else "refuted", f"m is {'positive on both sides' if both else 'not positive on both sides'}")


def _all_degenerate(curve, note):
    right = all(linear == "degenerate" for _, linear, _ in curve.segments)
    note(f"{curve.claim}: degenerate throughout", "proved" if right else "refuted", "m and n vanish identically along it")
    note(f"{curve.claim}: verdicts", "not checked", "no general rule for three zero eigenvalues all along")


def _crosses(rates, curve, ends) -> bool:
    """Whether the Jacobian has rank 1 or less at an exact parameter: two curves of equilibria meet."""
    if ends[0] != ends[1]:
        return False
    J = rates.jacobian(curve.at(ends[0]))
    pairs = ((0, 1), (0, 2), (1, 2))
    return all(J[a][c] * J[b][d] == J[a][d] * J[b][c] for a, b in pairs for c, d in pairs)


def _real_zeros(p):
    """(ball, multiplicity) of the real zeros of a rational polynomial."""
    if p.degree() < 1:
        return []
    from flint import arb
    return [(arb(z.real), k) for z, k in p.complex_roots() if z.imag.is_zero()]


def _agrees(end, mark) -> bool:
    """Whether a claimed end (None: infinity) holds the zero that was found."""
    if end is None or mark is None:
        return end is None and mark is None
    return hull(*end).overlaps(mark)


def _sign_between(m, low, high) -> int:
    """Sign of m between two neighbouring marks (None: infinity)."""
    from flint import fmpq
    exact = lambda z: Fraction(*map(int, _man(z)))  # noqa: E731
    if low is None and high is None:
        t = Fraction(0)
    elif low is None:
        t = exact(high) - 1 - abs(exact(high))
    elif high is None:
        t = exact(low) + 1 + abs(exact(low))
    else:
        t = (exact(low) + exact(high)) / 2
    value = fmpq(m(q(t)))
    return exact_sign(Fraction(int(value.p), int(value.q)))


def _man(z):
    """(numerator, denominator) of the middle of a ball."""
    mantissa, exponent = z.mid().man_exp()
    mantissa, exponent = int(mantissa), int(exponent)
    return (mantissa << exponent, 1) if exponent >= 0 else (mantissa, 1 << -exponent)
